// Half of a block under a cylinder, x >= 0 (mm): even triangles where it touches, larger and larger ones away from it.
// Mesh.MeshSizeFactor 1 gives sides of 0.025 mm there, a twentieth of the half-width of the contact.
zone = 1;                                      // twice the half-width of the contact
size = 10;                                     // of the half block
n = 4 * Round(10 / Mesh.MeshSizeFactor);       // sides along the zone; half as many down

Point(1) = {0, 0, 0};
Point(2) = {zone, 0, 0, 0.025};
Point(3) = {zone, -zone / 2, 0, 0.025};
Point(4) = {0, -zone / 2, 0, 0.025};
Point(5) = {size, 0, 0, 1};
Point(6) = {size, -size, 0, 1};
Point(7) = {0, -size, 0, 1};
Line(1) = {2, 1};
Line(2) = {1, 4};
Line(3) = {4, 3};
Line(4) = {3, 2};
Line(5) = {5, 2};
Line(6) = {4, 7};
Line(7) = {7, 6};
Line(8) = {6, 5};
Transfinite Curve {1, 3} = n + 1;
Transfinite Curve {2, 4} = n / 2 + 1;
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Surface {1};
Curve Loop(2) = {5, -4, -3, 6, 7, 8};
Plane Surface(2) = {2};

Physical Surface("block") = {1, 2};
Physical Curve("top") = {1};                   // the zone; what lies beyond does not touch
Physical Curve("middle") = {2, 6};
Physical Curve("bottom") = {7};
