"""Figures 2 to 9 of Lind & Wangenheim 2014 (IMECE2014-37998) with real and named inputs."""
