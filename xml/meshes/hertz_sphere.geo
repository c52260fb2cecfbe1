// A quarter of a block under a sphere, x >= 0, y >= 0 (mm): hexahedra, even where it touches, in growing layers away from it.
// Mesh.MeshSizeFactor 1 gives edges of 0.05 mm there, a tenth of the radius of the contact.
zone = 0.8;                                    // more than the radius of the contact
size = 5;                                      // of the quarter block
n = Round(16 / Mesh.MeshSizeFactor);           // edges along the zone
m = Round(12 / Mesh.MeshSizeFactor);           // layers beyond it,
growth = 1.28 ^ Mesh.MeshSizeFactor;           // each larger than the one before by this factor

// Three points along each axis: 0, the end of the zone, the end of the block; z downwards.
at[] = {0, zone, size};
For k In {0:2}
  For j In {0:2}
    For i In {0:2}
      Point(1 + i + 3 * j + 9 * k) = {at[i], at[j], -at[k]};
    EndFor
  EndFor
EndFor

// Curves 100 along x, 200 along y, 300 along z, named by the point they start at; the first of two is even.
For k In {0:2}
  For j In {0:2}
    For i In {0:1}
      p = 1 + i + 3 * j + 9 * k; Line(100 + p) = {p, p + 1};
      p = 1 + j + 3 * i + 9 * k; Line(200 + p) = {p, p + 3};
      p = 1 + j + 3 * k + 9 * i; Line(300 + p) = {p, p + 9};
    EndFor
  EndFor
EndFor
For a In {0:2}
  step = (a == 0) ? 1 : (a == 1) ? 3 : 9;
  For p In {1:27}
    place = Floor((p - 1) / step) % 3;
    If (place == 0)
      Transfinite Curve {100 * (a + 1) + p} = n + 1;
    EndIf
    If (place == 1)
      Transfinite Curve {100 * (a + 1) + p} = m + 1 Using Progression growth;
    EndIf
  EndFor
EndFor

// Surfaces 100 across x, 200 across y, 300 across z, named by the point with their smallest indices.
For p In {1:27}
  i = (p - 1) % 3; j = Floor((p - 1) / 3) % 3; k = Floor((p - 1) / 9);
  If (j < 2 && k < 2)
    Curve Loop(100 + p) = {200 + p, 300 + p + 3, -(200 + p + 9), -(300 + p)};
    Plane Surface(100 + p) = {100 + p};
  EndIf
  If (i < 2 && k < 2)
    Curve Loop(200 + p) = {100 + p, 300 + p + 1, -(100 + p + 9), -(300 + p)};
    Plane Surface(200 + p) = {200 + p};
  EndIf
  If (i < 2 && j < 2)
    Curve Loop(300 + p) = {100 + p, 200 + p + 1, -(100 + p + 3), -(200 + p)};
    Plane Surface(300 + p) = {300 + p};
  EndIf
EndFor
For k In {0:1}
  For j In {0:1}
    For i In {0:1}
      p = 1 + i + 3 * j + 9 * k;
      Surface Loop(p) = {100 + p, 101 + p, 200 + p, 203 + p, 300 + p, 309 + p};
      Volume(p) = {p};
    EndFor
  EndFor
EndFor
Transfinite Surface {Surface{:}};
Recombine Surface {Surface{:}};
Transfinite Volume {Volume{:}};

Physical Volume("block") = {Volume{:}};
Physical Surface("top") = {301};               // the zone; what lies beyond does not touch
Physical Surface("left") = {101, 104, 110, 113};
Physical Surface("front") = {201, 202, 210, 211};
Physical Surface("bottom") = {319, 320, 322, 323};
