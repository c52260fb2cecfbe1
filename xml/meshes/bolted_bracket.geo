// The bracket of bracket.geo and a plate below it (mm), with the holes of the bolts and the rims of their nuts' washers drawn
// on the underside. Tetrahedra, smaller where bolts press both together. Mesh.MeshSizeFactor 1 gives edges of 0.65 mm there.
Include "bracket.geo";
bracket() = Volume{:};
foot() = Surface In BoundingBox{-e, -width / 2 - e, -e, length + e, width / 2 + e, e};
from = -30; to = 110; broad = 90; deep = 10;   // the plate; its upper side is z = 0

Box(101) = {from, -broad / 2, -deep, to - from, broad, deep};
Cylinder(102) = {bolts, -width / 4, -deep - 1, 0, 0, deep + 2, bolt};
Cylinder(103) = {bolts, width / 4, -deep - 1, 0, 0, deep + 2, bolt};
BooleanDifference(104) = { Volume{101}; Delete; }{ Volume{102, 103}; Delete; };
For side In {-1:1:2}
  Disk(6000 + side) = {bolts, side * width / 4, -deep, washer};
  Disk(7000 + side) = {bolts, side * width / 4, -deep, bolt};
  BooleanDifference(8000 + side) = { Surface{6000 + side}; Delete; }{ Surface{7000 + side}; Delete; };
EndFor
Rectangle(9000) = {0, -width / 2, 0, length, width}; // where the bracket stands
Disk(9001) = {bolts, -width / 4, 0, bolt};
Disk(9002) = {bolts, width / 4, 0, bolt};
BooleanDifference(9003) = { Surface{9000}; Delete; }{ Surface{9001, 9002}; Delete; };
BooleanFragments{ Volume{104}; Delete; }{ Surface{7999, 8001, 9003}; Delete; }
plate() = Volume{:};
plate() -= {bracket()};

Field[1] = Box;                                // around the bolts
Field[1].XMin = bolts - 6;
Field[1].XMax = bolts + 9;
Field[1].YMin = -width / 2;
Field[1].YMax = width / 2;
Field[1].ZMin = -deep;
Field[1].ZMax = thick;
Field[1].VIn = 0.65;
Field[1].VOut = 3.25;
Field[1].Thickness = 30;
Field[2] = Box;                                // the bracket and what is below it
Field[2].XMin = 0;
Field[2].XMax = length;
Field[2].YMin = -width / 2;
Field[2].YMax = width / 2;
Field[2].ZMin = 0;
Field[2].ZMax = height;
Field[2].VIn = 0.975;
Field[2].VOut = 3.25;
Field[2].Thickness = 20;
Field[3] = Min;
Field[3].FieldsList = {1, 2};
Background Field = 3;
Mesh.MeshSizeMax = 3.25;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Physical Volume("plate") = {plate()};
top() = Surface In BoundingBox{-e, -width / 2 - e, -e, length + e, width / 2 + e, e};
top() -= {foot()};
Physical Surface("top") = {top()};
Physical Surface("nuts") = {Surface In BoundingBox{bolts - washer - e, -width / 4 - washer - e, -deep - e, bolts + washer + e, width / 4 + washer + e, -deep + e}};
Physical Surface("clamps") = {Surface In BoundingBox{from - e, -broad, -deep - e, from + e, broad, e}};
Physical Surface("clamps") += {Surface In BoundingBox{to - e, -broad, -deep - e, to + e, broad, e}};
