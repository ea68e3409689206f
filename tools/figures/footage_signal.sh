# Figures 2 and 4 of real footage: covered regions, glitches, short records. Sourced by footage.sh.
