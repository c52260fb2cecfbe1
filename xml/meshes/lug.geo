// A pin in a lug, a quarter of both, x >= 0, z >= 0 (mm): the pin's axis is z, the lug's shank points down. Tetrahedra,
// smaller where the pin's upper half bears, finest at the edge of the hole. Mesh.MeshSizeFactor 1 gives edges of 0.5 mm there.
SetFactory("OpenCASCADE");
pin = 10; clearance = 0.02;                    // radii: of the pin, of the hole less that
half = 7.5;                                    // of the lug's thickness
reach = 15;                                    // half the pin's length
outer = 22; shank = 16; length = 50;           // radius of the eye, half width of the shank, its end below the pin's axis
cheek = 8.5;                                   // from there on the fork holds the pin

Cylinder(1) = {0, 0, 0, 0, 0, half, outer};
Box(2) = {-shank, -length, 0, 2 * shank, length, half};
BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Cylinder(4) = {0, 0, 0, 0, 0, half, pin + clearance};
BooleanDifference(5) = { Volume{3}; Delete; }{ Volume{4}; Delete; };
Cylinder(6) = {0, 0, 0, 0, 0, cheek, pin};
Cylinder(7) = {0, 0, cheek, 0, 0, reach - cheek, pin};
Box(8) = {0, -2 * length, -1, length, 3 * length, reach + 2};
eye() = BooleanIntersection{ Volume{5}; Delete; }{ Volume{8}; };
parts() = BooleanIntersection{ Volume{6, 7}; Delete; }{ Volume{8}; Delete; };
BooleanFragments{ Volume{parts()}; Delete; }{}

Field[1] = MathEval;
Field[1].F = "0.5 + 0.2 * (((x^2 + y^2)^0.5 - 10)^2 + (0.4 * (z - 7.5))^2)^0.5 + 0.04 * ((y^2)^0.5 - y)";
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

e = 1e-3;
Physical Volume("lug") = eye();
Physical Volume("pin") = {Volume In BoundingBox {-e, -pin - e, -e, pin + e, pin + e, reach + e}};
front() = Surface In BoundingBox {-e, -length - e, -e, e, outer + e, reach + e};
middle() = Surface In BoundingBox {-e, -length - e, -e, outer + e, outer + e, e};
hole() = Surface In BoundingBox {-e, -pin - clearance - e, -e, pin + clearance + e, pin + clearance + e, half + e};
inside() = Surface In BoundingBox {-e, -pin - e, -e, pin + e, pin + e, cheek + e};
ends() = Surface In BoundingBox {-e, -pin - e, cheek - e, pin + e, pin + e, reach + e};
cuts() = Surface In BoundingBox {-e, -pin - e, reach - e, pin + e, pin + e, reach + e};
cuts() += Surface In BoundingBox {-e, -pin - e, cheek - e, pin + e, pin + e, cheek + e};
Physical Surface("front") = {front()};
Physical Surface("middle") = {middle()};
hole() -= {front(), middle()};
Physical Surface("hole") = {hole()};
inside() -= {front(), middle(), cuts()};
Physical Surface("shaft") = {inside()};
ends() -= {front(), cuts()};
Physical Surface("ends") = {ends()};
Physical Surface("foot") = {Surface In BoundingBox {-e, -length - e, -e, shank + e, -length + e, half + e}};
