/* The behaviour of the FMU, the same for FMI 2.0 and 3.0. */
#include "hyst_fmu.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Longer than any message below with its numbers. */
#define HYST_FMU_MESSAGE 320

/* An estimator has none; compilers object to loops that a constant 0 ends. */
static const size_t hyst_fmu_constant_count = HYST_FMU_CONSTANTS;

/* Defined for each version of FMI. */
static void hyst_fmu_tell(const hyst_fmu_instance *fmu, hyst_fmu_status status,
                          const char *message);

static hyst_fmu_status hyst_fmu_refuse(const hyst_fmu_instance *fmu, const char *message)
{
    hyst_fmu_tell(fmu, HYST_FMU_ERROR, message);
    return HYST_FMU_ERROR;
}

static int hyst_fmu_is_finite(double value)
{
    const double difference = value - value;
    return difference >= 0.0 && difference <= 0.0;
}

static void hyst_fmu_start(hyst_fmu_instance *fmu)
{
    memset(&fmu->now, 0, sizeof fmu->now);
    hyst_fmu_init(&fmu->now.stage);
    for (size_t i = 0; i < hyst_fmu_constant_count; ++i) {
        fmu->now.constant.value[i] = hyst_fmu_default[i];
    }
    fmu->now.mode = HYST_FMU_INSTANTIATED;
    fmu->fault_reported = 0;
}

static hyst_fmu_instance *hyst_fmu_create(const char *name, void *environment, void *logger,
                                          const char *token)
{
    const char *own_name = name != NULL ? name : "";
    hyst_fmu_instance *fmu = (hyst_fmu_instance *)calloc(1, sizeof *fmu);
    if (fmu == NULL) {
        return NULL;
    }
    fmu->environment = environment;
    fmu->logger = logger;
    fmu->name = (char *)malloc(strlen(own_name) + 1);
    if (fmu->name == NULL) {
        free(fmu);
        return NULL;
    }
    memcpy(fmu->name, own_name, strlen(own_name) + 1);
    if (token == NULL || strcmp(token, HYST_FMU_TOKEN) != 0) {
        hyst_fmu_refuse(fmu, "the token does not belong to this FMU; pass the one of its "
                             "modelDescription.xml");
        free(fmu->name);
        free(fmu);
        return NULL;
    }
    hyst_fmu_start(fmu);
    return fmu;
}

static void hyst_fmu_destroy(hyst_fmu_instance *fmu)
{
    if (fmu != NULL) {
        free(fmu->name);
        free(fmu);
    }
}

/* The output that the present input would have, found on a copy: initialization may look at it as
 * often as it likes, the memory moves with a step alone. */
static void hyst_fmu_find_output(hyst_fmu_instance *fmu)
{
    fmu->trial = fmu->now;
    fmu->now.output = hyst_fmu_evaluate(&fmu->trial.stage, &fmu->trial.constant, fmu->trial.input);
}

static hyst_fmu_status hyst_fmu_get_real(hyst_fmu_instance *fmu, uint32_t reference, double *value)
{
    if (reference == HYST_FMU_OUTPUT) {
        if (fmu->now.mode < HYST_FMU_STEPPING) {
            hyst_fmu_find_output(fmu);
        }
        *value = (double)fmu->now.output;
        return HYST_FMU_OK;
    }
    if (reference >= HYST_FMU_FIRST_INPUT && reference < HYST_FMU_OUTPUT) {
        *value = (double)fmu->now.input[reference - HYST_FMU_FIRST_INPUT];
        return HYST_FMU_OK;
    }
    if (reference >= HYST_FMU_FIRST_CONSTANT && reference < HYST_FMU_FIRST_ESTIMATE) {
        *value = (double)fmu->now.constant.value[reference - HYST_FMU_FIRST_CONSTANT];
        return HYST_FMU_OK;
    }
    if (reference >= HYST_FMU_FIRST_ESTIMATE && reference < HYST_FMU_END) {
        *value = (double)hyst_fmu_estimate(&fmu->now.stage, reference - HYST_FMU_FIRST_ESTIMATE);
        return HYST_FMU_OK;
    }
    if (reference == HYST_FMU_TIME) {
        *value = fmu->now.time;
        return HYST_FMU_OK;
    }
    return hyst_fmu_refuse(fmu, "there is no real variable of this value reference; take one of "
                                "modelDescription.xml");
}

static hyst_fmu_status hyst_fmu_set_constant(hyst_fmu_instance *fmu, size_t index, double value)
{
    const int rule = hyst_fmu_rule[index];
    if (rule == HYST_FMU_CONSTANT) {
        return hyst_fmu_refuse(fmu, "this constant of the model cannot be set; export the model "
                                    "with the value wanted");
    }
    if (rule != HYST_FMU_TUNABLE && fmu->now.mode >= HYST_FMU_STEPPING) {
        return hyst_fmu_refuse(fmu, "a fixed parameter cannot be set after initialization, because "
                                    "the memory belongs to it; reset the FMU first");
    }
    if (!hyst_fmu_is_finite(value)) {
        return hyst_fmu_refuse(fmu,
                               "a parameter was set to a value that is not finite; the old one "
                               "is kept, set a finite one");
    }
    if (rule == HYST_FMU_THRESHOLD && value < 0.0) {
        return hyst_fmu_refuse(fmu, "a threshold was set to a negative value; the old one is kept, "
                                    "set one >= 0");
    }
    fmu->now.constant.value[index] = value;
    return HYST_FMU_OK;
}

static hyst_fmu_status hyst_fmu_set_real(hyst_fmu_instance *fmu, uint32_t reference, double value)
{
    if (reference >= HYST_FMU_FIRST_INPUT && reference < HYST_FMU_OUTPUT) {
        fmu->now.input[reference - HYST_FMU_FIRST_INPUT] = value;
        return HYST_FMU_OK;
    }
    if (reference >= HYST_FMU_FIRST_CONSTANT && reference < HYST_FMU_FIRST_ESTIMATE) {
        return hyst_fmu_set_constant(fmu, reference - HYST_FMU_FIRST_CONSTANT, value);
    }
    return hyst_fmu_refuse(fmu, "only inputs and parameters can be set; take a value reference of "
                                "one from modelDescription.xml");
}

/* Samples in a communication step, or 0 and a message. A wrong step is an error, not a discarded
 * step: what importers do after that is to try the same step again. */
static uint32_t hyst_fmu_samples(const hyst_fmu_instance *fmu, double time, double step)
{
    char message[HYST_FMU_MESSAGE];
    if (!hyst_fmu_is_finite(time) || !hyst_fmu_is_finite(step) || step <= 0.0) {
        snprintf(message, sizeof message,
                 "the communication step from %.9g s of %.9g s was refused; a step must be finite "
                 "and longer than 0",
                 time, step);
    } else {
#ifdef HYST_FMU_DT
        /* A part in a million, as for records, and the rounding of two points in time; late in a
         * run that is too long for its clock, no more than a hundredth. */
        const double ratio = step / HYST_FMU_DT;
        const double rounding = 1e-15 * ((time < 0.0 ? -time : time) + step) / HYST_FMU_DT;
        const double tolerance = 1e-6 + (rounding < 0.01 ? rounding : 0.01);
        if (ratio < 4294967295.0) {
            const uint32_t samples = (uint32_t)(ratio + 0.5);
            const double rest = ratio - (double)samples;
            if (samples > 0 && rest <= tolerance && rest >= -tolerance) {
                return samples;
            }
        }
        snprintf(message, sizeof message,
                 "the communication step of %.9g s was refused; the model has a sample time of "
                 "%.9g s, so make the step a whole multiple of it",
                 step, HYST_FMU_DT);
#else
        return 1;
#endif
    }
    (void)hyst_fmu_refuse(fmu, message);
    return 0;
}

static hyst_fmu_status hyst_fmu_step(hyst_fmu_instance *fmu, double time, double step)
{
    uint32_t samples, fault;
    if (fmu->now.mode != HYST_FMU_STEPPING) {
        return hyst_fmu_refuse(fmu,
                               "a step was asked for before initialization had ended or after "
                               "the simulation had; enter and leave initialization mode first");
    }
    samples = hyst_fmu_samples(fmu, time, step);
    if (samples == 0) {
        return HYST_FMU_ERROR;
    }
    for (uint32_t k = 0; k < samples; ++k) {
        fmu->now.output = hyst_fmu_evaluate(&fmu->now.stage, &fmu->now.constant, fmu->now.input);
    }
    fmu->now.time = time + step;
    /* A drive held at its limits is told by the variable alone. */
    fault = hyst_fmu_fault(&fmu->now.stage) & ~(uint32_t)HYST_FMU_OUT_OF_RANGE;
    if ((fault & ~fmu->fault_reported) == 0) {
        return HYST_FMU_OK;
    }
    fmu->fault_reported |= fault;
    hyst_fmu_tell(
        fmu, HYST_FMU_WARNING,
        "an input or a value on its way through the model was not finite; the last output "
        "is held and the variable fault stays up until the FMU is reset");
    return HYST_FMU_WARNING;
}

static hyst_fmu_status hyst_fmu_enter_initialization(hyst_fmu_instance *fmu, double time)
{
    if (fmu->now.mode != HYST_FMU_INSTANTIATED) {
        return hyst_fmu_refuse(fmu, "initialization can be entered once; reset the FMU first");
    }
    if (!hyst_fmu_is_finite(time)) {
        return hyst_fmu_refuse(fmu, "the start time is not finite; give a finite one");
    }
    fmu->now.time = time;
    fmu->now.mode = HYST_FMU_INITIALIZING;
    return HYST_FMU_OK;
}

static hyst_fmu_status hyst_fmu_exit_initialization(hyst_fmu_instance *fmu)
{
    if (fmu->now.mode != HYST_FMU_INITIALIZING) {
        return hyst_fmu_refuse(fmu, "initialization mode was left without having been entered");
    }
    hyst_fmu_find_output(fmu);
    fmu->now.mode = HYST_FMU_STEPPING;
    return HYST_FMU_OK;
}

static hyst_fmu_status hyst_fmu_terminate(hyst_fmu_instance *fmu)
{
    if (fmu->now.mode != HYST_FMU_STEPPING) {
        return hyst_fmu_refuse(fmu, "there is no simulation to terminate");
    }
    fmu->now.mode = HYST_FMU_TERMINATED;
    return HYST_FMU_OK;
}

/* Saved states. A pointer that is not NULL is used again. */
static hyst_fmu_status hyst_fmu_get_values(const hyst_fmu_instance *fmu, void **values)
{
    if (values == NULL) {
        return hyst_fmu_refuse(fmu, "there is no place to put the state; pass a pointer");
    }
    if (*values == NULL) {
        *values = malloc(sizeof fmu->now);
    }
    if (*values == NULL) {
        return hyst_fmu_refuse(fmu, "there is no memory for the state; free some");
    }
    memcpy(*values, &fmu->now, sizeof fmu->now);
    return HYST_FMU_OK;
}

static hyst_fmu_status hyst_fmu_set_values(hyst_fmu_instance *fmu, const void *values)
{
    if (values == NULL) {
        return hyst_fmu_refuse(fmu, "there is no state to go back to; get one first");
    }
    memcpy(&fmu->now, values, sizeof fmu->now);
    fmu->fault_reported = hyst_fmu_fault(&fmu->now.stage);
    return HYST_FMU_OK;
}

static hyst_fmu_status hyst_fmu_free_values(void **values)
{
    if (values != NULL) {
        free(*values);
        *values = NULL;
    }
    return HYST_FMU_OK;
}

/* Numbers in an order of bytes that does not depend on the machine. */
static unsigned char *hyst_fmu_put(unsigned char *at, uint64_t bits)
{
    for (unsigned i = 0; i < 8; ++i) {
        *at++ = (unsigned char)(bits >> (8 * i) & 0xffu);
    }
    return at;
}

static uint64_t hyst_fmu_take(const unsigned char *at)
{
    uint64_t bits = 0;
    for (unsigned i = 0; i < 8; ++i) {
        bits |= (uint64_t)at[i] << (8 * i);
    }
    return bits;
}

static unsigned char *hyst_fmu_put_number(unsigned char *at, double number)
{
    uint64_t bits;
    memcpy(&bits, &number, sizeof bits);
    return hyst_fmu_put(at, bits);
}

static double hyst_fmu_take_number(const unsigned char *at)
{
    const uint64_t bits = hyst_fmu_take(at);
    double number;
    memcpy(&number, &bits, sizeof number);
    return number;
}

/* FNV-1a: tells damage, not malice. */
static uint64_t hyst_fmu_checksum(const unsigned char *bytes, size_t count)
{
    uint64_t sum = UINT64_C(14695981039346656037);
    for (size_t i = 0; i < count; ++i) {
        sum = (sum ^ bytes[i]) * UINT64_C(1099511628211);
    }
    return sum;
}

static hyst_fmu_status hyst_fmu_serialize(const hyst_fmu_instance *fmu, const void *saved,
                                          unsigned char *bytes, size_t size)
{
    const hyst_fmu_values *values = (const hyst_fmu_values *)saved;
    unsigned char *at = bytes;
    if (values == NULL || bytes == NULL || size < HYST_FMU_BYTES) {
        return hyst_fmu_refuse(fmu,
                               "the state cannot be serialized; pass a state and as many bytes "
                               "as its serialized size");
    }
    memcpy(at, HYST_FMU_TOKEN, sizeof(HYST_FMU_TOKEN));
    at += sizeof(HYST_FMU_TOKEN);
    hyst_fmu_save(&values->stage, at);
    at += HYST_FMU_SAVED_BYTES;
    for (size_t i = 0; i < hyst_fmu_constant_count; ++i) {
        at = hyst_fmu_put_number(at, (double)values->constant.value[i]);
    }
    for (size_t i = 0; i < HYST_FMU_INPUTS; ++i) {
        at = hyst_fmu_put_number(at, (double)values->input[i]);
    }
    at = hyst_fmu_put_number(at, (double)values->output);
    at = hyst_fmu_put_number(at, values->time);
    at = hyst_fmu_put(at, (uint64_t)values->mode);
    hyst_fmu_put(at, hyst_fmu_checksum(bytes, (size_t)(at - bytes)));
    return HYST_FMU_OK;
}

/* Fills values from bytes; 0 if they are not those of a state of this FMU. */
static int hyst_fmu_read(const unsigned char *bytes, size_t size, hyst_fmu_values *values)
{
    const unsigned char *at = bytes;
    if (size < HYST_FMU_BYTES || memcmp(at, HYST_FMU_TOKEN, sizeof(HYST_FMU_TOKEN)) != 0 ||
        hyst_fmu_take(bytes + HYST_FMU_BYTES - 8) != hyst_fmu_checksum(bytes, HYST_FMU_BYTES - 8)) {
        return 0;
    }
    at += sizeof(HYST_FMU_TOKEN);
    hyst_fmu_init(&values->stage);
    if (hyst_fmu_load(&values->stage, at) != 0) {
        return 0;
    }
    at += HYST_FMU_SAVED_BYTES;
    for (size_t i = 0; i < hyst_fmu_constant_count; ++i, at += 8) {
        values->constant.value[i] = hyst_fmu_take_number(at);
    }
    for (size_t i = 0; i < HYST_FMU_INPUTS; ++i, at += 8) {
        values->input[i] = hyst_fmu_take_number(at);
    }
    values->output = hyst_fmu_take_number(at);
    values->time = hyst_fmu_take_number(at + 8);
    if (hyst_fmu_take(at + 16) > (uint64_t)HYST_FMU_TERMINATED) {
        return 0;
    }
    values->mode = (hyst_fmu_mode)hyst_fmu_take(at + 16);
    return 1;
}

static hyst_fmu_status hyst_fmu_deserialize(const hyst_fmu_instance *fmu, const void *bytes,
                                            size_t size, void **saved)
{
    hyst_fmu_values *values;
    if (bytes == NULL || saved == NULL) {
        return hyst_fmu_refuse(fmu, "there are no bytes to read a state from; pass some");
    }
    values = (hyst_fmu_values *)calloc(1, sizeof *values);
    if (values == NULL || !hyst_fmu_read((const unsigned char *)bytes, size, values)) {
        free(values);
        return hyst_fmu_refuse(fmu,
                               "the bytes are not those of a state of this FMU, or are damaged; "
                               "pass what serializing one gave");
    }
    free(*saved);
    *saved = values;
    return HYST_FMU_OK;
}
