// Half of a block under a cylinder, x >= 0 (mm): small triangles where the contact ends and the pressure has a vertical
// tangent, larger and larger ones away from there. Mesh.MeshSizeFactor 1 gives sides of 0.01 mm there, of a fifth of the
// radius in the middle of the contact.
zone = 1;                                      // twice the half-width of the contact
size = 10;                                     // of the half block

Point(1) = {0, 0, 0};
Point(2) = {zone / 2, 0, 0};
Point(3) = {zone, 0, 0};
Point(4) = {size, 0, 0};
Point(5) = {size, -size, 0};
Point(6) = {0, -size, 0};
Line(1) = {2, 1};
Line(2) = {3, 2};
Line(3) = {4, 3};
Line(4) = {1, 6};
Line(5) = {6, 5};
Line(6) = {5, 4};
Curve Loop(1) = {3, 2, 1, 4, 5, 6};
Plane Surface(1) = {1};

Field[1] = MathEval;
Field[1].F = "0.01 + 0.25 * ((x - 0.5)^2 + y^2)^0.5";
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Physical Surface("block") = {1};
Physical Curve("top") = {1, 2};                // the zone; what lies beyond does not touch
Physical Curve("middle") = {4};
Physical Curve("bottom") = {5};
