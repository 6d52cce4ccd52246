// Two blocks of 2 x 1 that touch at y = 0, where each has vertices of its own; squares cut into two triangles.
Macro Body
  p = newp;
  Point(p) = {0, low, 0}; Point(p + 1) = {2, low, 0}; Point(p + 2) = {2, low + 1, 0}; Point(p + 3) = {0, low + 1, 0};
  l = newl;
  Line(l) = {p, p + 1}; Line(l + 1) = {p + 1, p + 2}; Line(l + 2) = {p + 2, p + 3}; Line(l + 3) = {p + 3, p};
  s = news;
  Curve Loop(s) = {l, l + 1, l + 2, l + 3};
  Plane Surface(s) = {s};
  Transfinite Curve {l, l + 2} = 2*n + 1;
  Transfinite Curve {l + 1, l + 3} = n + 1;
  Transfinite Surface {s};
Return

low = 0; n = 16;
Call Body;
Physical Surface("upper") = {s};
Physical Curve("upper.bottom") = {l};
Physical Curve("upper.right") = {l + 1};
Physical Curve("upper.top") = {l + 2};
Physical Curve("upper.left") = {l + 3};

low = -1; n = 12;
Call Body;
Physical Surface("lower") = {s};
Physical Curve("lower.bottom") = {l};
Physical Curve("lower.right") = {l + 1};
Physical Curve("lower.top") = {l + 2};
Physical Curve("lower.left") = {l + 3};
