// The right half of two discs that touch in the origin, a quarter each: one of radius R above y = 0, one below. Where they
// may come into contact both are cut straight, along y = 0; how far apart the circles are there is the gap of the case
// file. In small displacements that is the same problem, and the normal does not jump from facet to facet.

flat = 1.5;    // mm, length of the straight part
H = 1.5;       // and far from it

Macro Quarter  // the quarter disc of radius R whose centre lies at height side * R
  p = newp;
  height = side*Sqrt(R*R - flat*flat);
  Point(p) = {0, height, 0, H};                       // centre
  Point(p + 1) = {0, 0, 0, h};                        // first point of contact
  Point(p + 2) = {flat, 0, 0, h};
  Point(p + 3) = {R, height, 0, H};
  l = newl;
  Line(l) = {p + 1, p + 2};
  Circle(l + 1) = {p + 2, p, p + 3};
  Line(l + 2) = {p + 3, p};
  Line(l + 3) = {p, p + 1};
  s = news; Curve Loop(s) = {l, l + 1, l + 2, l + 3}; Plane Surface(s) = {s};
Return

R = 10; side = 1; h = 0.4;
Call Quarter;
Physical Surface("upper") = {s};
Physical Curve("upper.contact") = {l};
Physical Curve("top") = {l + 2};
free = l + 1; symmetry = l + 3;

R = 15; side = -1; h = 0.5;
Call Quarter;
Physical Surface("lower") = {s};
Physical Curve("lower.contact") = {l};
Physical Curve("bottom") = {l + 2};
Physical Curve("free") = {free, l + 1};
Physical Curve("symmetry") = {symmetry, l + 3};
