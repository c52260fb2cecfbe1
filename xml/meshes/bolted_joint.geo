// Two plates of steel on each other and a bolt through both, cut along y = 0 (mm). Each plate has a half of the bolt: its head
// or nut, as one with it, and the shank up to the middle, z = 0, where the plates touch. Mesh.MeshSizeFactor 1 gives edges of
// 2 mm at the joint.
SetFactory("OpenCASCADE");
length = 40; width = 16; thick = 6;      // half a plate
hole = 5; shank = 4; head = 8; high = 5; // radii, and how high the heads are
e = 1e-3;

For side In {-1:1:2}
  k = 100 * (side + 2);
  low = side < 0 ? -thick : 0;
  Box(k) = {-length / 2, 0, low, length, width, thick};
  Cylinder(k + 1) = {0, 0, side * thick, 0, 0, -side * thick, hole};
  BooleanDifference(k + 2) = { Volume{k}; Delete; }{ Volume{k + 1}; Delete; };
  Cylinder(k + 3) = {0, 0, side * thick, 0, 0, side * high, head};
  Cylinder(k + 4) = {0, 0, side * thick, 0, 0, -side * thick, shank};
  Box(k + 5) = {-2 * head, 0, side < 0 ? -thick - high : 0, 4 * head, 2 * head, thick + high};
  BooleanUnion(k + 6) = { Volume{k + 3}; Delete; }{ Volume{k + 4}; Delete; };
  BooleanIntersection(k + 7) = { Volume{k + 6}; Delete; }{ Volume{k + 5}; Delete; };
  BooleanUnion(k + 8) = { Volume{k + 2}; Delete; }{ Volume{k + 7}; Delete; };
EndFor

Mesh.MeshSizeMax = 4;
Field[1] = Box; // around the joint
Field[1].XMin = -length / 2;
Field[1].XMax = length / 2;
Field[1].YMin = 0;
Field[1].YMax = width;
Field[1].ZMin = -1;
Field[1].ZMax = 1;
Field[1].VIn = 2;
Field[1].VOut = 4;
Field[1].Thickness = 6;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeFromCurvature = 0;

curves() = Curve{:}; // circles have as many elements whatever the size: coarse ones of order 2 would fold
For i In {0:#curves() - 1}
  around() = BoundingBox Curve{curves(i)};
  If (around(4) > 1 && around(4) < width - 1)
    Transfinite Curve{curves(i)} = 9;
  EndIf
EndFor

Physical Volume("lower") = {108};
Physical Volume("upper") = {308};
Physical Surface("section") = {Surface In BoundingBox{-shank - e, -e, -e, shank + e, shank + e, e}};
joint() = Surface In BoundingBox{-length, -e, -e, length, width + e, e};
joint() -= {Surface In BoundingBox{-shank - e, -e, -e, shank + e, shank + e, e}};
Physical Surface("joint") = {joint()};
Physical Surface("cut") = {Surface In BoundingBox{-length, -e, -2 * thick - high, length, e, 2 * thick + high}};
Physical Surface("grips") = {Surface In BoundingBox{-length / 2 - e, -e, -thick - e, -length / 2 + e, width + e, e}};
Physical Surface("grips") += {Surface In BoundingBox{length / 2 - e, -e, -e, length / 2 + e, width + e, thick + e}};
