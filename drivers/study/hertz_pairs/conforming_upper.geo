// See ball.geo.
R = 20; side = 1; a = 12.5; h = 1.1; slope = 0.06;
Include "ball.geo";
