// The part |x| <= 0.5 of a disc of radius 1 that touches the plane y = 0 at the origin: 12 facets of second order.
n = 12; a = Asin(0.5); H = 0.1;
Point(1) = {-0.5, 1 - Cos(a), 0, H}; Point(2) = {0.5, 1 - Cos(a), 0, H}; Point(3) = {0, 1, 0, H};
Point(4) = {0.5, 0.5, 0, H}; Point(5) = {-0.5, 0.5, 0, H};
Circle(1) = {1, 3, 2};
Line(2) = {2, 4}; Line(3) = {4, 5}; Line(4) = {5, 1};
Transfinite Curve{1} = n + 1;
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Surface("body") = {1};
Physical Curve("arc") = {1};
Physical Curve("right") = {2};
Physical Curve("top") = {3};
Physical Curve("left") = {4};
Mesh.ElementOrder = 2;
