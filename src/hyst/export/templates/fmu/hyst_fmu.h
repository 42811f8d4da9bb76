/* What an FMU of either version of FMI is: one stage with its own constants, inputs and output.
 *
 * There are no globals: everything an instance has is in hyst_fmu_instance. Its constants are a
 * copy of the stage's, so that every instance may have others.
 *
 * hyst_model.h, written for each model, says which stage and which constants, and defines
 *   hyst_fmu_state, hyst_fmu_init, hyst_fmu_fault, hyst_fmu_save, hyst_fmu_load   of the stage
 *   fmu_constants                                union of them as double value[] and by name
 *   hyst_fmu_evaluate(state, constants, input)   one step
 *   hyst_fmu_estimate(state, place)              an estimated parameter, of HYST_FMU_ESTIMATES
 *   HYST_FMU_TOKEN, HYST_FMU_INPUTS, HYST_FMU_CONSTANTS, HYST_FMU_SAVED_BYTES
 *   HYST_FMU_DT                                  only if the model has a sample time, seconds
 *   hyst_fmu_default[], hyst_fmu_rule[]          value of each constant, and who may change it */
#ifndef HYST_FMU_H
#define HYST_FMU_H

#include <stddef.h>
#include <stdint.h>

/* Who may change a constant. */
enum {
    HYST_FMU_CONSTANT,  /* nobody: what it must satisfy cannot be checked here */
    HYST_FMU_FIXED,     /* until initialization has ended: the memory belongs to it */
    HYST_FMU_THRESHOLD, /* the same, and it must not be negative */
    HYST_FMU_TUNABLE    /* at any time: the memory does not depend on it */
};

#include "hyst_model.h"

/* Value references: time, inputs, output, fault, constants, estimated parameters. */
enum {
    HYST_FMU_TIME,
    HYST_FMU_FIRST_INPUT,
    HYST_FMU_OUTPUT = HYST_FMU_FIRST_INPUT + HYST_FMU_INPUTS,
    HYST_FMU_FAULT,
    HYST_FMU_FIRST_CONSTANT,
    HYST_FMU_FIRST_ESTIMATE = HYST_FMU_FIRST_CONSTANT + HYST_FMU_CONSTANTS,
    HYST_FMU_END = HYST_FMU_FIRST_ESTIMATE + HYST_FMU_ESTIMATES
};

/* The same numbers in FMI 2.0 and 3.0. */
/* The numbers of both standards; nothing is ever discarded. */
typedef enum { HYST_FMU_OK, HYST_FMU_WARNING, HYST_FMU_DISCARD, HYST_FMU_ERROR } hyst_fmu_status;

typedef enum {
    HYST_FMU_INSTANTIATED,
    HYST_FMU_INITIALIZING,
    HYST_FMU_STEPPING,
    HYST_FMU_TERMINATED
} hyst_fmu_mode;

/* All that a saved state of the FMU holds. */
typedef struct {
    hyst_fmu_state stage;
    fmu_constants constant;
    double input[HYST_FMU_INPUTS];
    double output;
    double time;
    hyst_fmu_mode mode;
} hyst_fmu_values;

typedef struct {
    hyst_fmu_values now;
    hyst_fmu_values trial;   /* to find the output without a step */
    uint32_t fault_reported; /* so that a fault is logged once */
    void *environment;
    void *logger; /* the fmi2CallbackFunctions, or where the fmi3LogMessageCallback is kept */
    char *name;
} hyst_fmu_instance;

/* Bytes of a serialized state: a mark, the stage's, everything else as numbers, a checksum. */
#define HYST_FMU_NUMBERS (HYST_FMU_CONSTANTS + HYST_FMU_INPUTS + 3)
#define HYST_FMU_BYTES (sizeof(HYST_FMU_TOKEN) + HYST_FMU_SAVED_BYTES + 8 * HYST_FMU_NUMBERS + 8)

#endif
