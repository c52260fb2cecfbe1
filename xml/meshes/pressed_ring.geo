// Half of a ring, x >= 0 (mm). Mesh.MeshSizeFactor 1 gives 160 quadrilaterals along the half circle and 16 through the wall.
outer = 10;
inner = 8;
n = 2 * Round(40 / Mesh.MeshSizeFactor);       // along a quarter
m = Round(16 / Mesh.MeshSizeFactor);           // through the wall

Point(1) = {0, 0, 0};
Point(2) = {0, -outer, 0};
Point(3) = {outer, 0, 0};
Point(4) = {0, outer, 0};
Point(5) = {0, -inner, 0};
Point(6) = {inner, 0, 0};
Point(7) = {0, inner, 0};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Circle(3) = {5, 1, 6};
Circle(4) = {6, 1, 7};
Line(5) = {5, 2};
Line(6) = {6, 3};
Line(7) = {7, 4};
Transfinite Curve {1, 2, 3, 4} = n + 1;
Transfinite Curve {5, 6, 7} = m + 1;
Curve Loop(1) = {1, -6, -3, 5};
Plane Surface(1) = {1};
Curve Loop(2) = {2, -7, -4, 6};
Plane Surface(2) = {2};
Transfinite Surface {1, 2};
Recombine Surface {1, 2};

Physical Surface("ring") = {1, 2};
Physical Curve("outside") = {1, 2};
Physical Curve("cut") = {5, 7};
