// A quarter of a wheel's rim on a rail's head, x >= 0, y >= 0 (mm): crossed cylinders that touch at the origin, cut where
// stresses are even. Tetrahedra, small where the contact ends and the pressure has a vertical tangent, larger and larger ones
// away from there. Mesh.MeshSizeFactor 1 gives edges of 0.35 mm there, a tenth of the contact's smaller semi-axis.
SetFactory("OpenCASCADE");
tread = 460;                                   // radius of the wheel, whose axis is along y
crown = 300;                                   // of the rail's head, along x
size = 36;                                     // of both parts

Box(1) = {0, 0, -size, size, size, size};
Cylinder(2) = {0, 0, -crown, size, 0, 0, crown};
BooleanIntersection(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Box(4) = {0, 0, 0, size, size, size};
Cylinder(5) = {0, 0, tread, 0, size, 0, tread};
BooleanIntersection(6) = { Volume{4}; Delete; }{ Volume{5}; Delete; };

Field[1] = MathEval;
Field[1].F = "0.35 + 0.175 * (16 * (((x / 4.6)^2 + (y / 3.5)^2)^0.5 - 1)^2 + z^2)^0.5";
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

e = 1e-3;
Physical Volume("rail") = 3;
Physical Volume("wheel") = 6;
Physical Surface("rail front") = {Surface In BoundingBox {-e, -e, -size - e, e, size + e, e}};
Physical Surface("rail side") = {Surface In BoundingBox {-e, -e, -size - e, size + e, e, e}};
Physical Surface("foot") = {Surface In BoundingBox {-e, -e, -size - e, size + e, size + e, -size + e}};
Physical Surface("wheel front") = {Surface In BoundingBox {-e, -e, -e, e, size + e, size + e}};
Physical Surface("wheel side") = {Surface In BoundingBox {-e, -e, -e, size + e, e, size + e}};
Physical Surface("web") = {Surface In BoundingBox {-e, -e, size - e, size + e, size + e, size + e}};
Physical Surface("head") = {Surface In BoundingBox {-e, -e, -5, size + e, size + e, e}};
Physical Surface("tread") = {Surface In BoundingBox {-e, -e, -e, size + e, size + e, 5}};
