// The polynomial of input and state; the file that holds the kind does not hold it.
#include "state_polynomial.c"
