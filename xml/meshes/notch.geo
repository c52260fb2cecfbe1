// A cube of 20 without one of its eight parts: three edges that meet in a corner, all re-entrant.
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 20, 20, 20};
Box(2) = {10, 10, 10, 20, 20, 20};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Mesh.MeshSizeMax = 6;

e = 1e-3;
Physical Volume("block") = {3};
Physical Surface("bottom") = {Surface In BoundingBox{-e, -e, -e, 20 + e, 20 + e, e}};
Physical Surface("left") = {Surface In BoundingBox{-e, -e, -e, e, 20 + e, 20 + e}};
Physical Surface("front") = {Surface In BoundingBox{-e, -e, -e, 20 + e, e, 20 + e}};
Physical Surface("top") = {Surface In BoundingBox{-e, -e, 20 - e, 20 + e, 20 + e, 20 + e}};
