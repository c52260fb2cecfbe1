// See ball.geo.
R = 40; side = -1; a = 0.5; h = 0.06; slope = 0.25;
Include "ball.geo";
