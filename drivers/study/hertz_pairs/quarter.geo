// Of a quarter of a body, x >= 0, y >= 0 (mm), Volume(3), that touches another one at the origin and is round there with radius R: sizes
// and surfaces. "contact" is the round one, "end" the one at z = end. Tetrahedra have edges of h at the rim of the contact, where the
// pressure has a vertical tangent, and grow by a quarter of the distance from it, in the contact by `slope` of that. a, radius of the
// contact, about.
rise = side * (R - R / Fabs(R) * (R^2 - a^2)^0.5); // of the rim of the contact
r = "(x^2 + y^2)^0.5";
Field[1] = MathEval;
Field[1].F = Sprintf(StrCat("%g + %g * ((", r, " - %g)^2 + (z - (%g))^2)^0.5 + %g * (Fabs((x^2 + y^2 + (z - (%g))^2)^0.5 - %g) + ",
                            "0.5 * (Fabs(", r, " - %g) + ", r, " - %g))"), h, slope, a, rise, 0.25 - slope, side * R, Fabs(R), a, a);
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

e = 1e-4;
far = 1e3;
left() = Surface In BoundingBox {-e, -e, -far, e, far, far};
front() = Surface In BoundingBox {-e, -e, -far, far, e, far};
end() = Surface In BoundingBox {-e, -e, end - e, far, far, end + e};
Physical Volume("body") = {3};
Physical Surface("contact") = {round()};
Physical Surface("left") = {left()};
Physical Surface("front") = {front()};
Physical Surface("end") = {end()};
