// See ball.geo.
R = 60; side = 1; a = 0.5; h = 0.075; slope = 0.25;
Include "ball.geo";
