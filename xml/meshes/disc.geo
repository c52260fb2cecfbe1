// A disc of radius 1 about the origin; Mesh.MeshSizeFactor 1 gives sides of 0.05.
SetFactory("OpenCASCADE");
Disk(1) = {0, 0, 0, 1, 1};
Physical Surface("disc") = {1};
Physical Curve("rim") = {1};
Mesh.MeshSizeMin = 0.05;
Mesh.MeshSizeMax = 0.05;
