// Half sections of a punch on a block, x the distance from the axis (mm). The punch's face is flat up to x = 40 and rounded
// with a radius of 10 from there on; small triangles where the contact ends.
Point(1) = {0, -200, 0};  Point(2) = {100, -200, 0};  Point(3) = {100, 0, 0};
Point(4) = {50, 0, 0};    Point(5) = {0, 0, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 5};  Line(5) = {5, 1};
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {1};

Point(6) = {0, 0, 0};     Point(7) = {40, 0, 0};      Point(8) = {40, 10, 0};
Point(9) = {50, 10, 0};   Point(10) = {50, 100, 0};   Point(11) = {0, 100, 0};
Line(6) = {6, 7};  Circle(7) = {7, 8, 9};  Line(8) = {9, 10};  Line(9) = {10, 11};  Line(10) = {11, 6};
Curve Loop(2) = {6, 7, 8, 9, 10};
Plane Surface(2) = {2};

Field[1] = MathEval;
Field[1].F = "0.5 + 0.25 * ((x - 40)^2 + y^2)^0.5";
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Physical Surface("block") = {1};
Physical Surface("punch") = {2};
Physical Curve("floor") = {1};
Physical Curve("top") = {4};                   // of the block
Physical Curve("face") = {6, 7};
Physical Curve("load") = {9};
