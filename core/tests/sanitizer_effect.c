/* Does on purpose what the sanitizers must stop: a sanitized build that lets one of these pass was
 * built without them. The argument names the fault; volatile keeps the compiler from seeing it. */
#include <limits.h>
#include <stdio.h>
#include <string.h>

int main(int count, char **arguments)
{
    const char *fault = count > 1 ? arguments[1] : "";
    volatile int large = INT_MAX;
    volatile int index = 4;
    volatile double huge = 1e30;
    volatile double zero = 0.0;
    int array[4] = {0, 0, 0, 0};
    int *volatile start = array;
    if (strcmp(fault, "overflow") == 0) {
        large = large + 1;
    } else if (strcmp(fault, "bounds") == 0) {
        start[index] = 1;
    } else if (strcmp(fault, "conversion") == 0) {
        large = (int)huge;
    } else if (strcmp(fault, "division") == 0) {
        huge = huge / zero;
    }
    printf("%s passed unnoticed: %d %g\n", fault, large, huge);
    return 0;
}
