// The balls of example 16: facets of second order.
Include "../../examples/16_hertz_on_spheres/ball_on_ball.geo";
Mesh.ElementOrder = 2;
