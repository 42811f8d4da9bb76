/* Times an FMU through its C API: driver LIBRARY VERSION TOKEN DT, prints steps per second. */
#define _POSIX_C_SOURCE 199309L
#include <dlfcn.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { STEPS = 2000000, PERIOD = 4096, RUNS = 7 };

typedef struct {
    void (*logger)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, int);
    void *environment;
} callbacks_2;

typedef void *instantiate_2(const char *, int, const char *, const char *, const callbacks_2 *, int,
                            int);
typedef void *instantiate_3(const char *, const char *, const char *, bool, bool, bool, bool,
                            const uint32_t *, size_t, void *,
                            void (*)(void *, int, const char *, const char *), void *);
typedef int enter_2(void *);
typedef int enter_3(void *, bool, double, double, bool, double);
typedef int set_2(void *, const unsigned *, size_t, const double *);
typedef int set_3(void *, const uint32_t *, size_t, const double *, size_t);
typedef int get_2(void *, const unsigned *, size_t, double *);
typedef int get_3(void *, const uint32_t *, size_t, double *, size_t);
typedef int step_2(void *, double, double, int);
typedef int step_3(void *, double, double, bool, bool *, bool *, bool *, double *);

static double input[PERIOD];

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void *symbol(void *library, const char *name)
{
    void *found = dlsym(library, name);
    if (found == NULL) {
        fprintf(stderr, "%s\n", dlerror());
        exit(1);
    }
    return found;
}

static double run_2(void *library, void *fmu, double dt, double *sum)
{
    set_2 *const set = (set_2 *)symbol(library, "fmi2SetReal");
    get_2 *const get = (get_2 *)symbol(library, "fmi2GetReal");
    step_2 *const step = (step_2 *)symbol(library, "fmi2DoStep");
    const unsigned u = 1, y = 2;
    const double begin = seconds();
    for (int k = 0; k < STEPS; ++k) {
        double value;
        if (set(fmu, &u, 1, &input[k % PERIOD]) + step(fmu, k * dt, dt, 1) +
            get(fmu, &y, 1, &value)) {
            exit(1);
        }
        *sum += value;
    }
    return seconds() - begin;
}

static double run_3(void *library, void *fmu, double dt, double *sum)
{
    set_3 *const set = (set_3 *)symbol(library, "fmi3SetFloat64");
    get_3 *const get = (get_3 *)symbol(library, "fmi3GetFloat64");
    step_3 *const step = (step_3 *)symbol(library, "fmi3DoStep");
    const uint32_t u = 1, y = 2;
    const double begin = seconds();
    for (int k = 0; k < STEPS; ++k) {
        double value, last;
        bool event, end, early;
        if (set(fmu, &u, 1, &input[k % PERIOD], 1) +
            step(fmu, k * dt, dt, true, &event, &end, &early, &last) + get(fmu, &y, 1, &value, 1)) {
            exit(1);
        }
        *sum += value;
    }
    return seconds() - begin;
}

int main(int count, char **argument)
{
    static const callbacks_2 callbacks;
    void *library = count == 5 ? dlopen(argument[1], RTLD_NOW | RTLD_LOCAL) : NULL;
    if (library == NULL) {
        fprintf(stderr, "%s\n", count == 5 ? dlerror() : "driver LIBRARY VERSION TOKEN DT");
        return 1;
    }
    const int is_2 = argument[2][0] == '2';
    const double dt = atof(argument[4]);
    double best = 1e9, sum = 0.0;
    void *fmu;
    uint32_t seed = 1;
    for (int k = 0, goal = 0, place = 0; k < PERIOD; ++k) {
        if (place == goal) {
            seed = seed * 1664525u + 1013904223u;
            goal = (int)((seed >> 8) % 512u) - 256;
        }
        place += goal > place ? 1 : goal < place ? -1 : 0;
        input[k] = place / 64.0;
    }
    if (is_2) {
        fmu = ((instantiate_2 *)symbol(library, "fmi2Instantiate"))("benchmark", 1, argument[3], "",
                                                                    &callbacks, 0, 0);
        if (fmu == NULL || ((enter_2 *)symbol(library, "fmi2EnterInitializationMode"))(fmu) ||
            ((enter_2 *)symbol(library, "fmi2ExitInitializationMode"))(fmu)) {
            return 1;
        }
    } else {
        fmu = ((instantiate_3 *)symbol(library, "fmi3InstantiateCoSimulation"))(
            "benchmark", argument[3], "", false, false, false, false, NULL, 0, NULL, NULL, NULL);
        if (fmu == NULL ||
            ((enter_3 *)symbol(library, "fmi3EnterInitializationMode"))(fmu, false, 0, 0, false, 0) ||
            ((enter_2 *)symbol(library, "fmi3ExitInitializationMode"))(fmu)) {
            return 1;
        }
    }
    for (int i = 0; i < RUNS; ++i) {
        const double time = is_2 ? run_2(library, fmu, dt, &sum) : run_3(library, fmu, dt, &sum);
        best = time < best ? time : best;
    }
    printf("%.0f %.17g\n", STEPS / best, sum);
    return 0;
}
