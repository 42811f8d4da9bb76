// The plan of a preview; the file that holds the kind does not hold it.
#include "rate_preview_plan.c"
