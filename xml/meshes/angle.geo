// An angle: a leg of 10 x 30 on a foot of 30 x 10, with a sharp corner between them.
Point(1) = {0, 0, 0, 5};
Point(2) = {30, 0, 0, 5};
Point(3) = {30, 10, 0, 5};
Point(4) = {10, 10, 0, 5};
Point(5) = {10, 30, 0, 5};
Point(6) = {0, 30, 0, 5};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6};
Plane Surface(1) = {1};

Physical Surface("angle") = {1};
Physical Curve("bottom") = {1};
Physical Curve("head") = {5};
Physical Curve("back") = {6};
