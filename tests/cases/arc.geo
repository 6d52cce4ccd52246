// The part |x| <= 0.5 of a disc of radius 1 that touches the plane y = 0 at the origin; its arc is a polygon of 12 facets.
n = 12; a = Asin(0.5); H = 0.1;
For i In {0:n}
  t = -a + 2*a*i/n;
  Point(i+1) = {Sin(t), 1 - Cos(t), 0, H};
EndFor
For i In {1:n}
  Line(i) = {i, i+1};
EndFor
Point(n+2) = {0.5, 0.5, 0, H}; Point(n+3) = {-0.5, 0.5, 0, H};
Line(n+1) = {n+1, n+2}; Line(n+2) = {n+2, n+3}; Line(n+3) = {n+3, 1};
Curve Loop(1) = {1:n+3};
Plane Surface(1) = {1};
Physical Surface("body") = {1};
Physical Curve("arc") = {1:n};
Physical Curve("right") = {n+1};
Physical Curve("top") = {n+2};
Physical Curve("left") = {n+3};
