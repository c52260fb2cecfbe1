// A quarter of a block with a hollow of half a ball in its top, below the contact, for a file that says before it includes this one:
// R, the hollow's radius, negative; size, of the quarter block; a, h and slope, see quarter.geo.
SetFactory("OpenCASCADE");
Sphere(1) = {0, 0, 0, -R, -Pi / 2, Pi / 2, 2 * Pi};
Rotate {{1, 0, 0}, {0, 0, 0}, Pi / 2} {Volume{1};} // the poles of its coordinates away from the contact
Translate {0, 0, -R} {Volume{1};}
Box(2) = {0, 0, -R - size, size, size, size};
BooleanDifference(3) = {Volume{2}; Delete;}{Volume{1}; Delete;};

side = -1;
end = -R - size;
round() = Surface In BoundingBox {-1e-4, -1e-4, -1e-4, 1e-4 - R, 1e-4 - R, 1e-4 - R};
Include "quarter.geo";
