// The plate below the bracket of bracket.geo (mm), with the holes of its bolts and the rims of their nuts' washers drawn on the
// underside. Tetrahedra, smaller around the holes and below the foot. Mesh.MeshSizeFactor 1 gives edges of 1.2 mm there.
SetFactory("OpenCASCADE");
from = -30; to = 110; width = 90; thick = 10;  // the plate; its upper side is z = 0
length = 80; foot = 60;                        // of the bracket's foot, along x and y
bolt = 4.5; washer = 9;                        // radii
bolts = length - 20; side = 15;                // x and +-y of the bolts

Box(1) = {from, -width / 2, -thick, to - from, width, thick};
Cylinder(2) = {bolts, -side, -thick - 1, 0, 0, thick + 2, bolt};
Cylinder(3) = {bolts, side, -thick - 1, 0, 0, thick + 2, bolt};
BooleanDifference(4) = { Volume{1}; Delete; }{ Volume{2, 3}; Delete; };
For i In {-1:1:2}
  Disk(1000 + i) = {bolts, i * side, -thick, washer};
  Disk(2000 + i) = {bolts, i * side, -thick, bolt};
  BooleanDifference(3000 + i) = { Surface{1000 + i}; Delete; }{ Surface{2000 + i}; Delete; };
EndFor
Rectangle(4000) = {0, -foot / 2, 0, length, foot}; // where the bracket stands
Disk(4001) = {bolts, -side, 0, bolt};
Disk(4002) = {bolts, side, 0, bolt};
BooleanDifference(4003) = { Surface{4000}; Delete; }{ Surface{4001, 4002}; Delete; };
BooleanFragments{ Volume{4}; Delete; }{ Surface{2999, 3001, 4003}; Delete; }

Field[1] = Box;                                // below the foot
Field[1].XMin = 0; Field[1].XMax = length;
Field[1].YMin = -foot / 2; Field[1].YMax = foot / 2;
Field[1].ZMin = -thick; Field[1].ZMax = 1;
Field[1].VIn = 1.4; Field[1].VOut = 4; Field[1].Thickness = 25;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

e = 1e-3;
Physical Volume("plate") = {Volume{:}};
Physical Surface("top") = {Surface In BoundingBox{-e, -foot / 2 - e, -e, length + e, foot / 2 + e, e}};
Physical Surface("nuts") = {Surface In BoundingBox{bolts - washer - e, -side - washer - e, -thick - e, bolts + washer + e, side + washer + e, -thick + e}};
Physical Surface("ends") = {Surface In BoundingBox{from - e, -width, -thick - e, from + e, width, e}};
Physical Surface("ends") += {Surface In BoundingBox{to - e, -width, -thick - e, to + e, width, e}};
