// A bracket of steel (mm): a foot with two bolt holes, a wall with an eye, a fillet between them. The foot stands on z = 0,
// washers sit on it around the holes. Mesh.MeshSizeFactor 1 gives about 35 000 nodes.
SetFactory("OpenCASCADE");
length = 80;                                   // of the foot, along x
width = 60;                                    // along y
height = 60;                                   // of the wall, along z
thick = 8;                                     // of foot and wall
fillet = 8;
bolt = 4.5; washer = 9;                        // radii
bolts = length - 20;                           // x of the bolts; y = +-width / 4
eye = 8;                                       // radius
axis = height - 20;                            // z of the eye
Mesh.MeshSizeMax = 1.2;

Box(1) = {0, -width / 2, 0, length, width, thick};
Box(2) = {0, -width / 2, 0, thick, width, height};
Box(3) = {thick, -width / 2, thick, fillet, width, fillet};
Cylinder(4) = {thick + fillet, -width / 2, thick + fillet, 0, width, 0, fillet};
BooleanDifference(5) = { Volume{3}; Delete; }{ Volume{4}; Delete; };
BooleanUnion(6) = { Volume{1}; Delete; }{ Volume{2, 5}; Delete; };
Cylinder(7) = {-1, 0, axis, thick + 2, 0, 0, eye};
Cylinder(8) = {bolts, -width / 4, -1, 0, 0, thick + 2, bolt};
Cylinder(9) = {bolts, width / 4, -1, 0, 0, thick + 2, bolt};
BooleanDifference(10) = { Volume{6}; Delete; }{ Volume{7, 8, 9}; Delete; };

// The washers' rims are drawn on the foot.
For side In {-1:1:2}
  Disk(1000 + side) = {bolts, side * width / 4, thick, washer};
  Disk(2000 + side) = {bolts, side * width / 4, thick, bolt};
  BooleanDifference(3000 + side) = { Surface{1000 + side}; Delete; }{ Surface{2000 + side}; Delete; };
EndFor
BooleanFragments{ Volume{10}; Delete; }{ Surface{2999, 3001}; Delete; }

e = 1e-3;
Physical Volume("bracket") = {Volume{:}};
Physical Surface("bottom") = {Surface In BoundingBox{-e, -width / 2 - e, -e, length + e, width / 2 + e, e}};
Physical Surface("holes") = {Surface In BoundingBox{bolts - bolt - e, -width / 4 - bolt - e, -e, bolts + bolt + e, width / 4 + bolt + e, thick + e}};
Physical Surface("washers") = {Surface In BoundingBox{bolts - washer - e, -width / 4 - washer - e, thick - e, bolts + washer + e, width / 4 + washer + e, thick + e}};
Physical Surface("eye") = {Surface In BoundingBox{-e, -eye - e, axis - eye - e, thick + e, eye + e, axis + eye + e}};
