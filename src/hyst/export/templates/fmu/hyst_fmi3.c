/* FMI 3.0, co-simulation: the standard's functions in terms of hyst_fmu.c. */
#include "hyst_fmi3.h"

static void hyst_fmu_tell(const hyst_fmu_instance *fmu, hyst_fmu_status status, const char *message)
{
    static const char *const category[] = {"logAll", "logStatusWarning", "logStatusDiscard",
                                           "logStatusError"};
    /* C lets no pointer to a function be stored as a pointer to data other than byte by byte. */
    union {
        fmi3LogMessageCallback function;
        void *pointer;
    } logger;
    logger.function = NULL;
    logger.pointer = fmu->logger;
    if (logger.function != NULL) {
        logger.function(fmu->environment, (fmi3Status)status, category[status], message);
    }
}

static fmi3Status hyst_fmi3_none(fmi3Instance instance, const char *message)
{
    return instance != NULL ? (fmi3Status)hyst_fmu_refuse((hyst_fmu_instance *)instance, message)
                            : fmi3Error;
}

const char *fmi3GetVersion(void)
{
    return "3.0";
}

fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean loggingOn, size_t nCategories,
                               const fmi3String categories[])
{
    (void)loggingOn;
    (void)nCategories;
    (void)categories;
    return instance != NULL ? fmi3OK : fmi3Error;
}

fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath,
    fmi3Boolean visible, fmi3Boolean loggingOn, fmi3Boolean eventModeUsed,
    fmi3Boolean earlyReturnAllowed, const fmi3ValueReference requiredIntermediateVariables[],
    size_t nRequiredIntermediateVariables, fmi3InstanceEnvironment instanceEnvironment,
    fmi3LogMessageCallback logMessage, fmi3IntermediateUpdateCallback intermediateUpdate)
{
    union {
        fmi3LogMessageCallback function;
        void *pointer;
    } logger;
    logger.pointer = NULL;
    logger.function = logMessage;
    (void)resourcePath;
    (void)visible;
    (void)loggingOn;
    (void)eventModeUsed;
    (void)earlyReturnAllowed;
    (void)requiredIntermediateVariables;
    (void)nRequiredIntermediateVariables;
    (void)intermediateUpdate;
    return hyst_fmu_create(instanceName, instanceEnvironment, logger.pointer, instantiationToken);
}

void fmi3FreeInstance(fmi3Instance instance)
{
    hyst_fmu_destroy((hyst_fmu_instance *)instance);
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean toleranceDefined,
                                       fmi3Float64 tolerance, fmi3Float64 startTime,
                                       fmi3Boolean stopTimeDefined, fmi3Float64 stopTime)
{
    (void)toleranceDefined;
    (void)tolerance;
    (void)stopTimeDefined;
    (void)stopTime;
    if (instance == NULL) {
        return fmi3Error;
    }
    return (fmi3Status)hyst_fmu_enter_initialization((hyst_fmu_instance *)instance, startTime);
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance instance)
{
    return instance != NULL
               ? (fmi3Status)hyst_fmu_exit_initialization((hyst_fmu_instance *)instance)
               : fmi3Error;
}

fmi3Status fmi3Terminate(fmi3Instance instance)
{
    return instance != NULL ? (fmi3Status)hyst_fmu_terminate((hyst_fmu_instance *)instance)
                            : fmi3Error;
}

fmi3Status fmi3Reset(fmi3Instance instance)
{
    if (instance == NULL) {
        return fmi3Error;
    }
    hyst_fmu_start((hyst_fmu_instance *)instance);
    return fmi3OK;
}

fmi3Status fmi3GetFloat64(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                          size_t nValueReferences, fmi3Float64 values[], size_t nValues)
{
    hyst_fmu_status status = instance != NULL ? HYST_FMU_OK : HYST_FMU_ERROR;
    if (instance != NULL && nValues != nValueReferences) {
        return hyst_fmi3_none(instance,
                              "every variable is one number; pass as many values as value "
                              "references");
    }
    for (size_t i = 0; i < nValueReferences && status == HYST_FMU_OK; ++i) {
        status = hyst_fmu_get_real((hyst_fmu_instance *)instance, valueReferences[i], &values[i]);
    }
    return (fmi3Status)status;
}

fmi3Status fmi3GetUInt32(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                         size_t nValueReferences, fmi3UInt32 values[], size_t nValues)
{
    hyst_fmu_instance *fmu = (hyst_fmu_instance *)instance;
    if (fmu == NULL) {
        return fmi3Error;
    }
    for (size_t i = 0; i < nValueReferences; ++i) {
        if (valueReferences[i] != HYST_FMU_FAULT || nValues != nValueReferences) {
            return hyst_fmi3_none(instance, "the only UInt32 variable is fault, one number");
        }
        values[i] = hyst_fmu_fault(&fmu->now.stage);
    }
    return fmi3OK;
}

fmi3Status fmi3SetFloat64(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                          size_t nValueReferences, const fmi3Float64 values[], size_t nValues)
{
    hyst_fmu_status status = instance != NULL ? HYST_FMU_OK : HYST_FMU_ERROR;
    if (instance != NULL && nValues != nValueReferences) {
        return hyst_fmi3_none(instance,
                              "every variable is one number; pass as many values as value "
                              "references");
    }
    for (size_t i = 0; i < nValueReferences && status == HYST_FMU_OK; ++i) {
        status = hyst_fmu_set_real((hyst_fmu_instance *)instance, valueReferences[i], values[i]);
    }
    return (fmi3Status)status;
}

fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState *FMUState)
{
    return instance != NULL
               ? (fmi3Status)hyst_fmu_get_values((hyst_fmu_instance *)instance, FMUState)
               : fmi3Error;
}

fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState FMUState)
{
    return instance != NULL
               ? (fmi3Status)hyst_fmu_set_values((hyst_fmu_instance *)instance, FMUState)
               : fmi3Error;
}

fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState *FMUState)
{
    (void)instance;
    return (fmi3Status)hyst_fmu_free_values(FMUState);
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState FMUState, size_t *size)
{
    (void)FMUState;
    if (instance == NULL || size == NULL) {
        return fmi3Error;
    }
    *size = HYST_FMU_BYTES;
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState FMUState,
                                 fmi3Byte serializedState[], size_t size)
{
    if (instance == NULL) {
        return fmi3Error;
    }
    return (fmi3Status)hyst_fmu_serialize((hyst_fmu_instance *)instance, FMUState, serializedState,
                                          size);
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance instance, const fmi3Byte serializedState[],
                                   size_t size, fmi3FMUState *FMUState)
{
    if (instance == NULL) {
        return fmi3Error;
    }
    return (fmi3Status)hyst_fmu_deserialize((hyst_fmu_instance *)instance, serializedState, size,
                                            FMUState);
}

fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 currentCommunicationPoint,
                      fmi3Float64 communicationStepSize,
                      fmi3Boolean noSetFMUStatePriorToCurrentPoint,
                      fmi3Boolean *eventHandlingNeeded, fmi3Boolean *terminateSimulation,
                      fmi3Boolean *earlyReturn, fmi3Float64 *lastSuccessfulTime)
{
    hyst_fmu_instance *fmu = (hyst_fmu_instance *)instance;
    fmi3Status status;
    (void)noSetFMUStatePriorToCurrentPoint;
    if (fmu == NULL || eventHandlingNeeded == NULL || terminateSimulation == NULL ||
        earlyReturn == NULL || lastSuccessfulTime == NULL) {
        return fmi3Error;
    }
    *eventHandlingNeeded = fmi3False;
    *terminateSimulation = fmi3False;
    *earlyReturn = fmi3False;
    status = (fmi3Status)hyst_fmu_step(fmu, currentCommunicationPoint, communicationStepSize);
    *lastSuccessfulTime = fmu->now.time;
    return status;
}
