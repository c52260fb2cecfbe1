// A sector of a cylindrical roller bearing (mm): the lower part of its rings, five rollers between them that touch both, and
// the cage's bars between the rollers. Small triangles where rollers touch, larger and larger ones away from there.
// Mesh.MeshSizeFactor 1 gives sides of 0.025 mm there, an eighth of the half-width of the most loaded contact.
pitch = 25; roller = 5;                        // radii
bore = 14; seat = 36;                          // radii
between = Pi / 6;                              // angle from roller to roller
end = 80 * Pi / 180;                           // where rings and cage are cut
low = pitch - 1.5; high = pitch + 1.5;         // radii of the cage

Point(1) = {0, 0, 0};

// A point of radius r at an angle from straight down, counter-clockwise.
Macro At
  p = newp;
  Point(p) = {r * Sin(angle), -r * Cos(angle), 0};
Return

// An arc of radius r from end to end through where each roller touches.
Macro Raceway
  angle = -end; Call At;
  from = p; last = p; raceway() = {};
  For i In {-2:2}
    angle = i * between; Call At;
    touch() += p;
    c = newc; Circle(c) = {last, 1, p}; raceway() += c; last = p;
  EndFor
  angle = end; Call At;
  c = newc; Circle(c) = {last, 1, p}; raceway() += c; to = p;
Return

// The ring between a raceway and an arc of radius r.
Macro Ring
  angle = -end; Call At;
  a = p;
  angle = 0; Call At;
  m = p;
  angle = end; Call At;
  b = p;
  c1 = newc; Circle(c1) = {a, 1, m};
  c2 = newc; Circle(c2) = {m, 1, b};
  c3 = newc; Line(c3) = {to, b};
  c4 = newc; Line(c4) = {a, from};
  l = newll; Curve Loop(l) = {raceway(), c3, -c2, -c1, c4};
  f = news; Plane Surface(f) = {l};
Return

touch() = {};
r = pitch - roller; Call Raceway;
r = bore; Call Ring;
Physical Surface("inner ring") = f;
Physical Curve("inner raceway") = {raceway()};
Physical Curve("bore") = {c1, c2};
r = pitch + roller; Call Raceway;
r = seat; Call Ring;
ReverseMesh Surface{f};
Physical Surface("outer ring") = f;
Physical Curve("outer raceway") = {raceway()};
Physical Curve("seat") = {c1, c2};

// Rollers and bars have points and arcs of their own. The cage's sides end at rollers at these angles from their middle.
lowAngle = Acos((pitch^2 + low^2 - roller^2) / (2 * pitch * low));
highAngle = Acos((pitch^2 + high^2 - roller^2) / (2 * pitch * high));

// The ends of the cage's sides right (side = 1) or left of a roller, and its centre.
Macro Corners
  angle = i * between; r = pitch; Call At;
  centre = p;
  angle = i * between + side * lowAngle; r = low; Call At;
  lower = p;
  angle = i * between + side * highAngle; r = high; Call At;
  upper = p;
Return

For i In {-2:2}
  side = 1; Call Corners;
  b = lower; c = upper;
  side = -1; Call Corners;
  a = lower; d = upper;
  angle = i * between;
  r = pitch - roller; Call At;
  in = p;
  r = pitch + roller; Call At;
  out = p;
  touch() += {in, out};
  c1 = newc; Circle(c1) = {a, centre, in};
  c2 = newc; Circle(c2) = {in, centre, b};
  c3 = newc; Circle(c3) = {b, centre, c};
  c4 = newc; Circle(c4) = {c, centre, out};
  c5 = newc; Circle(c5) = {out, centre, d};
  c6 = newc; Circle(c6) = {d, centre, a};
  l = newll; Curve Loop(l) = {c1, c2, c3, c4, c5, c6};
  f = news; Plane Surface(f) = {l};
  ReverseMesh Surface{f};
  Physical Surface(Sprintf("roller %g", i + 3)) = f;
  Physical Curve(Sprintf("roller %g in", i + 3)) = {c1, c2};
  Physical Curve(Sprintf("roller %g out", i + 3)) = {c4, c5};
  Physical Curve(Sprintf("roller %g right", i + 3)) = c3;
  Physical Curve(Sprintf("roller %g left", i + 3)) = c6;
EndFor

For i In {-3:2}                                // from roller i to the next one; the first and the last bar to the cut
  If(i > -3)
    side = 1; Call Corners;
    a = lower; d = upper; left = centre;
  Else
    angle = -end; r = low; Call At;
    a = p; r = high; Call At;
    d = p;
  EndIf
  i += 1;
  If(i < 3)
    side = -1; Call Corners;
    b = lower; c = upper; right = centre;
  Else
    angle = end; r = low; Call At;
    b = p; r = high; Call At;
    c = p;
  EndIf
  i -= 1;
  c1 = newc; Circle(c1) = {a, 1, b};
  c3 = newc; Circle(c3) = {c, 1, d};
  c2 = newc;
  If(i < 2)
    Circle(c2) = {b, right, c};
  Else
    Line(c2) = {b, c};
  EndIf
  c4 = newc;
  If(i > -3)
    Circle(c4) = {d, left, a};
  Else
    Line(c4) = {d, a};
  EndIf
  l = newll; Curve Loop(l) = {c1, c2, c3, c4};
  f = news; Plane Surface(f) = {l};
  ReverseMesh Surface{f};
  Physical Surface(Sprintf("bar %g", i + 4)) = f;
  Physical Curve(Sprintf("bar %g right", i + 4)) = c2;
  Physical Curve(Sprintf("bar %g left", i + 4)) = c4;
EndFor

Field[1] = Distance;
Field[1].PointsList = {touch()};
Field[2] = MathEval;
Field[2].F = "0.025 + 0.13 * (F1 - 0.2 + Sqrt((F1 - 0.2)^2))";
Field[3] = MathEval;
Field[3].F = "0.8";
Field[4] = Min;
Field[4].FieldsList = {2, 3};
Background Field = 4;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
