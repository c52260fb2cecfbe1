// A quarter of a half ball, cut at the height of its centre, for a file that says before it includes this one: R, radius; side, 1
// above the contact, -1 below; a, h and slope, see quarter.geo.
SetFactory("OpenCASCADE");
Sphere(1) = {0, 0, 0, R, -Pi / 2, Pi / 2, 2 * Pi};
Rotate {{1, 0, 0}, {0, 0, 0}, Pi / 2} {Volume{1};} // the poles of its coordinates away from the contact
Translate {0, 0, side * R} {Volume{1};}
Box(2) = {0, 0, (side - 1) / 2 * R, R, R, R};
BooleanIntersection(3) = {Volume{1}; Delete;}{Volume{2}; Delete;};

end = side * R;
round() = Surface{:};
round() -= {Surface In BoundingBox {-1e-4, -1e-4, -1e3, 1e-4, 1e3, 1e3}};
round() -= {Surface In BoundingBox {-1e-4, -1e-4, -1e3, 1e3, 1e-4, 1e3}};
round() -= {Surface In BoundingBox {-1e-4, -1e-4, end - 1e-4, 1e3, 1e3, end + 1e-4}};
Include "quarter.geo";
