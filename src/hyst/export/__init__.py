"""Models as code for other tools: C for firmware, FMU for simulation, MEX for MATLAB and Octave."""
