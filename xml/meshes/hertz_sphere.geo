// A quarter of a block under a sphere, x >= 0, y >= 0 (mm): tetrahedra, small where the contact ends and the pressure has a
// vertical tangent, larger and larger ones away from there. Mesh.MeshSizeFactor 1 gives edges of 0.06 mm there, an eighth of
// the radius of the contact.
SetFactory("OpenCASCADE");
zone = 0.8;                                    // more than the radius of the contact
size = 5;                                      // of the quarter block

Box(1) = {0, 0, -size, size, size, size};
Rectangle(100) = {0, 0, 0, zone, zone};
BooleanFragments{ Volume{1}; Delete; }{ Surface{100}; Delete; }

Field[1] = MathEval;
Field[1].F = "0.06 + 0.25 * (((x^2 + y^2)^0.5 - 0.5)^2 + z^2)^0.5";
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

e = 1e-4;
Physical Volume("block") = {1};
Physical Surface("top") = {Surface In BoundingBox {-e, -e, -e, zone + e, zone + e, e}}; // what lies beyond does not touch
Physical Surface("left") = {Surface In BoundingBox {-e, -e, -size - e, e, size + e, e}};
Physical Surface("front") = {Surface In BoundingBox {-e, -e, -size - e, size + e, e, e}};
Physical Surface("bottom") = {Surface In BoundingBox {-e, -e, -size - e, size + e, size + e, -size + e}};
