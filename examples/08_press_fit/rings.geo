// A quarter of two rings, lengths in mm: the inner one from radius 40 to 50, the outer one from 50 to 70. They share no
// point: at radius 50 each has a boundary of its own.
SetFactory("OpenCASCADE");

Macro Ring
  c = newp; Point(c) = {0, 0, 0, size};
  p = newp;
  Point(p) = {inner, 0, 0, size};
  Point(p + 1) = {outer, 0, 0, size};
  Point(p + 2) = {0, outer, 0, size};
  Point(p + 3) = {0, inner, 0, size};
  l = newl;
  Line(l) = {p, p + 1};
  Circle(l + 1) = {p + 1, c, p + 2};
  Line(l + 2) = {p + 2, p + 3};
  Circle(l + 3) = {p + 3, c, p};
  s = news; Curve Loop(s) = {l, l + 1, l + 2, l + 3}; Plane Surface(s) = {s};
Return

inner = 40; outer = 50; size = 2.5;
Call Ring;
Physical Surface("shaft") = {s};
Physical Curve("shaft.outside") = {l + 1};
Physical Curve("shaft.inside") = {l + 3};
bottom = l; left = l + 2;

inner = 50; outer = 70; size = 3;
Call Ring;
Physical Surface("hub") = {s};
Physical Curve("hub.outside") = {l + 1};
Physical Curve("hub.inside") = {l + 3};
Physical Curve("bottom") = {bottom, l};
Physical Curve("left") = {left, l + 2};
