// Two equal half cylinders that touch at the origin (mm): small triangles along the contact, larger and larger ones away
// from it. Mesh.MeshSizeFactor 1 gives sides of a twentieth of the contact's half-width.
R = 50;
a = 0.5;                                       // half-width of the contact, about
zone = 1.5 * a;
rise = R - (R^2 - zone^2)^0.5;

For k In {0:1}
  side = 2 * k - 1;                            // the lower body, then the upper one
  n = 10 * k;
  Point(n + 1) = {0, 0, 0};
  Point(n + 2) = {zone, side * rise, 0};
  Point(n + 3) = {R, side * R, 0};
  Point(n + 4) = {0, side * R, 0};             // the axis
  Point(n + 5) = {-R, side * R, 0};
  Point(n + 6) = {-zone, side * rise, 0};
  Circle(n + 1) = {n + 1, n + 4, n + 2};
  Circle(n + 2) = {n + 2, n + 4, n + 3};
  Line(n + 3) = {n + 3, n + 4};
  Line(n + 4) = {n + 4, n + 5};
  Circle(n + 5) = {n + 5, n + 4, n + 6};
  Circle(n + 6) = {n + 6, n + 4, n + 1};
  Curve Loop(k + 1) = {n + 1, n + 2, n + 3, n + 4, n + 5, n + 6};
  Plane Surface(k + 1) = {side * (k + 1)};
EndFor

Field[1] = MathEval;
Field[1].F = Sprintf("0.025 + 0.25 * (((abs(x) - %g + abs(abs(x) - %g)) / 2)^2 + y^2)^0.5", a, a);
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Physical Surface("lower") = {1};
Physical Surface("upper") = {2};
Physical Curve("lower contact") = {1, 6};      // the zone; what lies beyond does not touch
Physical Curve("lower cut") = {3, 4};
Physical Curve("upper contact") = {11, 16};
Physical Curve("upper cut") = {13, 14};
