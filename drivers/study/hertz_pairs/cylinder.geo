// Half of a half cylinder, x >= 0 (mm), that touches the other one at the origin, for a file that says before it includes this one:
// R, radius; side, 1 above the contact, -1 below; h, sides where the contact ends and the pressure has a vertical tangent.
// Triangles grow from there.
a = 0.5;                                       // half-width of the contact, about
zone = 2 * a;

Point(1) = {0, 0, 0};
Point(2) = {a, side * (R - (R^2 - a^2)^0.5), 0};
Point(3) = {zone, side * (R - (R^2 - zone^2)^0.5), 0};
Point(4) = {R, side * R, 0};
Point(5) = {0, side * R, 0};                   // the axis
Circle(1) = {1, 5, 2};
Circle(2) = {2, 5, 3};
Circle(3) = {3, 5, 4};
Line(4) = {4, 5};
Line(5) = {5, 1};
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {side};

Field[1] = MathEval;
Field[1].F = Sprintf("%g + 0.25 * ((x - %g)^2 + y^2)^0.5", h, a);
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Physical Surface("half") = {1};
Physical Curve("contact") = {1, 2};            // the zone; what lies beyond does not touch
Physical Curve("middle") = {5};
Physical Curve("cut") = {4};
