// A monolith of the dam, 15 m between two contraction joints: the section of dam_on_rock.geo drawn out along z, on rock that
// goes on beside its ends. Dam and rock share no point.
SetFactory("OpenCASCADE");

height = 50;      // m, of the dam
crest = 5;        // m
slope = 0.8;      // of the downstream face, horizontal : vertical
base = crest + slope*height;
length = 15;      // m, of the monolith
aside = 30;       // m, of rock beside each end
width = 60;       // m, of rock on either side of the dam
depth = 60;       // m, of rock
h = 10;           // mesh sizes: the run refines where it must
h_far = 30;
e = 1e-3;

// The rock, its top divided at the dam and at the water's edge.
Box(1) = {-width, -depth, -aside, 2*width + base, depth, length + 2*aside};
Point(101) = {0, 0, 0};
Point(102) = {base, 0, 0};
Point(103) = {base, 0, length};
Point(104) = {0, 0, length};
Line(101) = {101, 102};
Line(102) = {102, 103};
Line(103) = {103, 104};
Line(104) = {104, 101};
Curve Loop(101) = {101, 102, 103, 104};
Plane Surface(101) = {101};
Point(105) = {0, 0, -aside};
Point(106) = {0, 0, length + aside};
Line(105) = {105, 101};
Line(106) = {104, 106};
divided[] = BooleanFragments{ Volume{1}; Delete; }{ Surface{101}; Curve{105, 106}; Delete; };
foundation[] = Surface In BoundingBox {-e, -e, -e, base + e, e, length + e};
reservoir[] = Surface In BoundingBox {-width - e, -e, -aside - e, e, e, length + aside + e};
top[] = Surface In BoundingBox {-width - e, -e, -aside - e, base + width + e, e, length + aside + e};
top[] -= {foundation[], reservoir[]};
deep[] = Surface In BoundingBox {-width - e, -depth - e, -aside - e, base + width + e, -depth + e, length + aside + e};
left[] = Surface In BoundingBox {-width - e, -depth - e, -aside - e, -width + e, e, length + aside + e};
right[] = Surface In BoundingBox {base + width - e, -depth - e, -aside - e, base + width + e, e, length + aside + e};
front[] = Surface In BoundingBox {-width - e, -depth - e, -aside - e, base + width + e, e, -aside + e};
back[] = Surface In BoundingBox {-width - e, -depth - e, length + aside - e, base + width + e, e, length + aside + e};

// The dam, drawn out: the far end, the volume, then a face per line.
Point(1001) = {0, 0, 0};                        // heel
Point(1002) = {base, 0, 0};                     // toe
Point(1003) = {crest, height, 0};
Point(1004) = {0, height, 0};
Line(1001) = {1001, 1002};
Line(1002) = {1002, 1003};
Line(1003) = {1003, 1004};
Line(1004) = {1004, 1001};
Curve Loop(1001) = {1001, 1002, 1003, 1004};
Plane Surface(1001) = {1001};
dam[] = Extrude {0, 0, length} { Surface{1001}; };

MeshSize { PointsOf { Volume{divided[0]}; } } = h_far;
MeshSize { PointsOf { Surface{foundation[]}; Volume{dam[1]}; } } = h;

Physical Volume("concrete") = {dam[1]};
Physical Volume("rock") = {divided[0]};
Physical Surface("ends") = {1001, dam[0]};
Physical Surface("base") = {dam[2]};
Physical Surface("downstream") = {dam[3]};
Physical Surface("crest") = {dam[4]};
Physical Surface("upstream") = {dam[5]};
Physical Surface("foundation") = {foundation[]};
Physical Surface("reservoir") = {reservoir[]};
Physical Surface("valley") = {top[]};
Physical Surface("far") = {left[], right[]};
Physical Surface("beside") = {front[], back[]};
Physical Surface("deep") = {deep[]};
