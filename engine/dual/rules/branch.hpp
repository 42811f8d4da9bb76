// Branches of differential models: the file that holds a kind does not hold them.
#include "branch.c"
