/* FMI 2.0, co-simulation: the standard's functions in terms of hyst_fmu.c. */
#include "hyst_fmi2.h"

static void hyst_fmu_tell(const hyst_fmu_instance *fmu, hyst_fmu_status status, const char *message)
{
    static const char *const category[] = {"logAll", "logStatusWarning", "logStatusDiscard",
                                           "logStatusError"};
    const fmi2CallbackFunctions *callbacks = (const fmi2CallbackFunctions *)fmu->logger;
    if (callbacks != NULL && callbacks->logger != NULL) {
        callbacks->logger(fmu->environment, fmu->name, (fmi2Status)status, category[status],
                          message);
    }
}

const char *fmi2GetTypesPlatform(void)
{
    return fmi2TypesPlatform;
}

const char *fmi2GetVersion(void)
{
    return "2.0";
}

fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type fmuType, fmi2String fmuGUID,
                              fmi2String fmuResourceLocation,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible,
                              fmi2Boolean loggingOn)
{
    void *environment = functions != NULL ? functions->componentEnvironment : NULL;
    (void)fmuResourceLocation;
    (void)visible;
    (void)loggingOn;
    if (fmuType != fmi2CoSimulation) {
        return NULL;
    }
    /* The standard keeps the callbacks alive as long as the instance; only it reads them. */
    return hyst_fmu_create(instanceName, environment, (void *)(uintptr_t)functions, fmuGUID);
}

void fmi2FreeInstance(fmi2Component c)
{
    hyst_fmu_destroy((hyst_fmu_instance *)c);
}

/* Only warnings and errors are ever logged, and these always are. */
fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean loggingOn, size_t nCategories,
                               const fmi2String categories[])
{
    (void)loggingOn;
    (void)nCategories;
    (void)categories;
    return c != NULL ? fmi2OK : fmi2Error;
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance,
                               fmi2Real startTime, fmi2Boolean stopTimeDefined, fmi2Real stopTime)
{
    hyst_fmu_instance *fmu = (hyst_fmu_instance *)c;
    (void)toleranceDefined;
    (void)tolerance;
    (void)stopTimeDefined;
    (void)stopTime;
    if (fmu == NULL) {
        return fmi2Error;
    }
    fmu->now.time = startTime;
    return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    hyst_fmu_instance *fmu = (hyst_fmu_instance *)c;
    return fmu != NULL ? (fmi2Status)hyst_fmu_enter_initialization(fmu, fmu->now.time) : fmi2Error;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    return c != NULL ? (fmi2Status)hyst_fmu_exit_initialization((hyst_fmu_instance *)c) : fmi2Error;
}

fmi2Status fmi2Terminate(fmi2Component c)
{
    return c != NULL ? (fmi2Status)hyst_fmu_terminate((hyst_fmu_instance *)c) : fmi2Error;
}

fmi2Status fmi2Reset(fmi2Component c)
{
    if (c == NULL) {
        return fmi2Error;
    }
    hyst_fmu_start((hyst_fmu_instance *)c);
    return fmi2OK;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Real value[])
{
    hyst_fmu_status status = c != NULL ? HYST_FMU_OK : HYST_FMU_ERROR;
    for (size_t i = 0; i < nvr && status == HYST_FMU_OK; ++i) {
        status = hyst_fmu_get_real((hyst_fmu_instance *)c, vr[i], &value[i]);
    }
    return (fmi2Status)status;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                       const fmi2Real value[])
{
    hyst_fmu_status status = c != NULL ? HYST_FMU_OK : HYST_FMU_ERROR;
    for (size_t i = 0; i < nvr && status == HYST_FMU_OK; ++i) {
        status = hyst_fmu_set_real((hyst_fmu_instance *)c, vr[i], value[i]);
    }
    return (fmi2Status)status;
}

fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                          fmi2Integer value[])
{
    hyst_fmu_instance *fmu = (hyst_fmu_instance *)c;
    if (fmu == NULL) {
        return fmi2Error;
    }
    for (size_t i = 0; i < nvr; ++i) {
        if (vr[i] != HYST_FMU_FAULT) {
            return (fmi2Status)hyst_fmu_refuse(fmu, "the only integer variable is fault");
        }
        value[i] = (fmi2Integer)hyst_fmu_fault(&fmu->now.stage);
    }
    return fmi2OK;
}

/* What there is none of: no variable of such a type, no capability of this kind. */
static fmi2Status hyst_fmi2_none(fmi2Component c, size_t count, const char *message)
{
    if (c == NULL) {
        return fmi2Error;
    }
    return count == 0 ? fmi2OK : (fmi2Status)hyst_fmu_refuse((hyst_fmu_instance *)c, message);
}

fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                          fmi2Boolean value[])
{
    (void)vr;
    (void)value;
    return hyst_fmi2_none(c, nvr, "there are no boolean variables");
}

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                         fmi2String value[])
{
    (void)vr;
    (void)value;
    return hyst_fmi2_none(c, nvr, "there are no string variables");
}

fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                          const fmi2Integer value[])
{
    (void)vr;
    (void)value;
    return hyst_fmi2_none(c, nvr, "no integer variable can be set; reset the FMU to lower fault");
}

fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                          const fmi2Boolean value[])
{
    (void)vr;
    (void)value;
    return hyst_fmi2_none(c, nvr, "there are no boolean variables");
}

fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                         const fmi2String value[])
{
    (void)vr;
    (void)value;
    return hyst_fmi2_none(c, nvr, "there are no string variables");
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *FMUstate)
{
    return c != NULL ? (fmi2Status)hyst_fmu_get_values((hyst_fmu_instance *)c, FMUstate)
                     : fmi2Error;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate FMUstate)
{
    return c != NULL ? (fmi2Status)hyst_fmu_set_values((hyst_fmu_instance *)c, FMUstate)
                     : fmi2Error;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *FMUstate)
{
    (void)c;
    return (fmi2Status)hyst_fmu_free_values(FMUstate);
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate FMUstate, size_t *size)
{
    (void)FMUstate;
    if (c == NULL || size == NULL) {
        return fmi2Error;
    }
    *size = HYST_FMU_BYTES;
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate FMUstate, fmi2Byte serializedState[],
                                 size_t size)
{
    if (c == NULL) {
        return fmi2Error;
    }
    return (fmi2Status)hyst_fmu_serialize((hyst_fmu_instance *)c, FMUstate,
                                          (unsigned char *)serializedState, size);
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte serializedState[], size_t size,
                                   fmi2FMUstate *FMUstate)
{
    if (c == NULL) {
        return fmi2Error;
    }
    return (fmi2Status)hyst_fmu_deserialize((hyst_fmu_instance *)c, serializedState, size,
                                            FMUstate);
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference vUnknown_ref[],
                                        size_t nUnknown, const fmi2ValueReference vKnown_ref[],
                                        size_t nKnown, const fmi2Real dvKnown[],
                                        fmi2Real dvUnknown[])
{
    (void)vUnknown_ref;
    (void)vKnown_ref;
    (void)nKnown;
    (void)dvKnown;
    (void)dvUnknown;
    return hyst_fmi2_none(c, nUnknown, "the FMU provides no directional derivatives");
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                       const fmi2Integer order[], const fmi2Real value[])
{
    (void)vr;
    (void)order;
    (void)value;
    return hyst_fmi2_none(c, nvr, "the FMU holds its input over a step and takes no derivatives");
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                        const fmi2Integer order[], fmi2Real value[])
{
    (void)vr;
    (void)order;
    (void)value;
    return hyst_fmi2_none(c, nvr, "the FMU provides no derivatives of its output");
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real currentCommunicationPoint,
                      fmi2Real communicationStepSize, fmi2Boolean noSetFMUStatePriorToCurrentPoint)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    return c != NULL ? (fmi2Status)hyst_fmu_step((hyst_fmu_instance *)c, currentCommunicationPoint,
                                                 communicationStepSize)
                     : fmi2Error;
}

fmi2Status fmi2CancelStep(fmi2Component c)
{
    return hyst_fmi2_none(c, 1, "steps are not asynchronous; there is none to cancel");
}

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind s, fmi2Status *value)
{
    (void)s;
    (void)value;
    return hyst_fmi2_none(c, 1, "steps are not asynchronous; their status is what they return");
}

/* After a refused step nothing has moved: the last successful time is the present one. */
fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind s, fmi2Real *value)
{
    if (c != NULL && value != NULL && s == fmi2LastSuccessfulTime) {
        *value = ((const hyst_fmu_instance *)c)->now.time;
        return fmi2OK;
    }
    return hyst_fmi2_none(c, 1, "the only real status is the last successful time");
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind s, fmi2Integer *value)
{
    (void)s;
    (void)value;
    return hyst_fmi2_none(c, 1, "there is no integer status");
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind s, fmi2Boolean *value)
{
    if (c != NULL && value != NULL && s == fmi2Terminated) {
        *value = fmi2False;
        return fmi2OK;
    }
    return hyst_fmi2_none(c, 1, "the only boolean status is whether the FMU wants to end");
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind s, fmi2String *value)
{
    (void)s;
    (void)value;
    return hyst_fmi2_none(c, 1, "there is no string status");
}
