// The pieces that hyst_preisach_step is made of; the file that holds the kind does not hold them.
#include "preisach_branch.c"
