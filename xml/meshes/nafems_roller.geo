// Half of a half roller of radius 50 on a block, by symmetry x >= 0 (mm); small triangles where the contact ends.
Point(1) = {0, -200, 0};  Point(2) = {100, -200, 0};  Point(3) = {100, 0, 0};  Point(4) = {0, 0, 0};
Point(5) = {12, 0, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 5};  Line(4) = {5, 4};  Line(5) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {1};

Point(6) = {0, 0, 0};  Point(7) = {0, 50, 0};  Point(8) = {50, 50, 0};
Point(9) = {50 * Sin(0.25), 50 - 50 * Cos(0.25), 0};
Circle(6) = {6, 7, 9};  Circle(7) = {9, 7, 8};  Line(8) = {8, 7};  Line(9) = {7, 6};
Curve Loop(2) = {6, 7, 8, 9};
Plane Surface(2) = {2};

Field[1] = MathEval;
Field[1].F = "0.3 + 0.2 * ((x - 6.2)^2 + y^2)^0.5";
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Physical Surface("block") = {1};
Physical Surface("roller") = {2};
Physical Curve("floor") = {1};
Physical Curve("top") = {4};                   // of the block, as far as it can touch
Physical Curve("block middle") = {5};
Physical Curve("face") = {6};
Physical Curve("diameter") = {8};
Physical Curve("roller middle") = {9};
