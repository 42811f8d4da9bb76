/* The part of FMI 2.0 that a co-simulation FMU implements: types and functions, declared as the
 * standard has them (https://fmi-standard.org, sections 2.1 and 4.2). */
#ifndef HYST_FMI2_H
#define HYST_FMI2_H

#include <stddef.h>

#define fmi2TypesPlatform "default"
#define fmi2True 1
#define fmi2False 0

typedef void *fmi2Component;
typedef void *fmi2ComponentEnvironment;
typedef void *fmi2FMUstate;
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean;
typedef char fmi2Char;
typedef const fmi2Char *fmi2String;
typedef char fmi2Byte;

typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum {
    fmi2DoStepStatus,
    fmi2PendingStatus,
    fmi2LastSuccessfulTime,
    fmi2Terminated
} fmi2StatusKind;

typedef void (*fmi2CallbackLogger)(fmi2ComponentEnvironment, fmi2String instanceName, fmi2Status,
                                   fmi2String category, fmi2String message, ...);

typedef struct {
    fmi2CallbackLogger logger;
    void *(*allocateMemory)(size_t count, size_t size);
    void (*freeMemory)(void *memory);
    void (*stepFinished)(fmi2ComponentEnvironment, fmi2Status);
    fmi2ComponentEnvironment componentEnvironment;
} fmi2CallbackFunctions;

#if defined(FMI2_FUNCTION_PREFIX) && !defined(FMI2_OVERRIDE_FUNCTION_PREFIX)
#define FMI2_Export
#define HYST_FMI2_PASTE(a, b) a##b
#define HYST_FMI2_JOIN(a, b) HYST_FMI2_PASTE(a, b)
#define HYST_FMI2_NAME(name) HYST_FMI2_JOIN(FMI2_FUNCTION_PREFIX, name)
#define fmi2GetTypesPlatform HYST_FMI2_NAME(fmi2GetTypesPlatform)
#define fmi2GetVersion HYST_FMI2_NAME(fmi2GetVersion)
#define fmi2SetDebugLogging HYST_FMI2_NAME(fmi2SetDebugLogging)
#define fmi2Instantiate HYST_FMI2_NAME(fmi2Instantiate)
#define fmi2FreeInstance HYST_FMI2_NAME(fmi2FreeInstance)
#define fmi2SetupExperiment HYST_FMI2_NAME(fmi2SetupExperiment)
#define fmi2EnterInitializationMode HYST_FMI2_NAME(fmi2EnterInitializationMode)
#define fmi2ExitInitializationMode HYST_FMI2_NAME(fmi2ExitInitializationMode)
#define fmi2Terminate HYST_FMI2_NAME(fmi2Terminate)
#define fmi2Reset HYST_FMI2_NAME(fmi2Reset)
#define fmi2GetReal HYST_FMI2_NAME(fmi2GetReal)
#define fmi2GetInteger HYST_FMI2_NAME(fmi2GetInteger)
#define fmi2GetBoolean HYST_FMI2_NAME(fmi2GetBoolean)
#define fmi2GetString HYST_FMI2_NAME(fmi2GetString)
#define fmi2SetReal HYST_FMI2_NAME(fmi2SetReal)
#define fmi2SetInteger HYST_FMI2_NAME(fmi2SetInteger)
#define fmi2SetBoolean HYST_FMI2_NAME(fmi2SetBoolean)
#define fmi2SetString HYST_FMI2_NAME(fmi2SetString)
#define fmi2GetFMUstate HYST_FMI2_NAME(fmi2GetFMUstate)
#define fmi2SetFMUstate HYST_FMI2_NAME(fmi2SetFMUstate)
#define fmi2FreeFMUstate HYST_FMI2_NAME(fmi2FreeFMUstate)
#define fmi2SerializedFMUstateSize HYST_FMI2_NAME(fmi2SerializedFMUstateSize)
#define fmi2SerializeFMUstate HYST_FMI2_NAME(fmi2SerializeFMUstate)
#define fmi2DeSerializeFMUstate HYST_FMI2_NAME(fmi2DeSerializeFMUstate)
#define fmi2GetDirectionalDerivative HYST_FMI2_NAME(fmi2GetDirectionalDerivative)
#define fmi2SetRealInputDerivatives HYST_FMI2_NAME(fmi2SetRealInputDerivatives)
#define fmi2GetRealOutputDerivatives HYST_FMI2_NAME(fmi2GetRealOutputDerivatives)
#define fmi2DoStep HYST_FMI2_NAME(fmi2DoStep)
#define fmi2CancelStep HYST_FMI2_NAME(fmi2CancelStep)
#define fmi2GetStatus HYST_FMI2_NAME(fmi2GetStatus)
#define fmi2GetRealStatus HYST_FMI2_NAME(fmi2GetRealStatus)
#define fmi2GetIntegerStatus HYST_FMI2_NAME(fmi2GetIntegerStatus)
#define fmi2GetBooleanStatus HYST_FMI2_NAME(fmi2GetBooleanStatus)
#define fmi2GetStringStatus HYST_FMI2_NAME(fmi2GetStringStatus)
#elif defined(_WIN32) || defined(__CYGWIN__)
#define FMI2_Export __declspec(dllexport)
#elif defined(__GNUC__)
#define FMI2_Export __attribute__((visibility("default")))
#else
#define FMI2_Export
#endif

FMI2_Export const char *fmi2GetTypesPlatform(void);
FMI2_Export const char *fmi2GetVersion(void);
FMI2_Export fmi2Status fmi2SetDebugLogging(fmi2Component, fmi2Boolean on, size_t count,
                                           const fmi2String category[]);

FMI2_Export fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type, fmi2String guid,
                                          fmi2String resources, const fmi2CallbackFunctions *,
                                          fmi2Boolean visible, fmi2Boolean loggingOn);
FMI2_Export void fmi2FreeInstance(fmi2Component);

FMI2_Export fmi2Status fmi2SetupExperiment(fmi2Component, fmi2Boolean toleranceDefined,
                                           fmi2Real tolerance, fmi2Real startTime,
                                           fmi2Boolean stopTimeDefined, fmi2Real stopTime);
FMI2_Export fmi2Status fmi2EnterInitializationMode(fmi2Component);
FMI2_Export fmi2Status fmi2ExitInitializationMode(fmi2Component);
FMI2_Export fmi2Status fmi2Terminate(fmi2Component);
FMI2_Export fmi2Status fmi2Reset(fmi2Component);

FMI2_Export fmi2Status fmi2GetReal(fmi2Component, const fmi2ValueReference[], size_t, fmi2Real[]);
FMI2_Export fmi2Status fmi2GetInteger(fmi2Component, const fmi2ValueReference[], size_t,
                                      fmi2Integer[]);
FMI2_Export fmi2Status fmi2GetBoolean(fmi2Component, const fmi2ValueReference[], size_t,
                                      fmi2Boolean[]);
FMI2_Export fmi2Status fmi2GetString(fmi2Component, const fmi2ValueReference[], size_t,
                                     fmi2String[]);
FMI2_Export fmi2Status fmi2SetReal(fmi2Component, const fmi2ValueReference[], size_t,
                                   const fmi2Real[]);
FMI2_Export fmi2Status fmi2SetInteger(fmi2Component, const fmi2ValueReference[], size_t,
                                      const fmi2Integer[]);
FMI2_Export fmi2Status fmi2SetBoolean(fmi2Component, const fmi2ValueReference[], size_t,
                                      const fmi2Boolean[]);
FMI2_Export fmi2Status fmi2SetString(fmi2Component, const fmi2ValueReference[], size_t,
                                     const fmi2String[]);

FMI2_Export fmi2Status fmi2GetFMUstate(fmi2Component, fmi2FMUstate *);
FMI2_Export fmi2Status fmi2SetFMUstate(fmi2Component, fmi2FMUstate);
FMI2_Export fmi2Status fmi2FreeFMUstate(fmi2Component, fmi2FMUstate *);
FMI2_Export fmi2Status fmi2SerializedFMUstateSize(fmi2Component, fmi2FMUstate, size_t *);
FMI2_Export fmi2Status fmi2SerializeFMUstate(fmi2Component, fmi2FMUstate, fmi2Byte[], size_t);
FMI2_Export fmi2Status fmi2DeSerializeFMUstate(fmi2Component, const fmi2Byte[], size_t,
                                               fmi2FMUstate *);

FMI2_Export fmi2Status fmi2GetDirectionalDerivative(fmi2Component, const fmi2ValueReference[],
                                                    size_t, const fmi2ValueReference[], size_t,
                                                    const fmi2Real[], fmi2Real[]);
FMI2_Export fmi2Status fmi2SetRealInputDerivatives(fmi2Component, const fmi2ValueReference[],
                                                   size_t, const fmi2Integer[], const fmi2Real[]);
FMI2_Export fmi2Status fmi2GetRealOutputDerivatives(fmi2Component, const fmi2ValueReference[],
                                                    size_t, const fmi2Integer[], fmi2Real[]);

FMI2_Export fmi2Status fmi2DoStep(fmi2Component, fmi2Real time, fmi2Real step, fmi2Boolean);
FMI2_Export fmi2Status fmi2CancelStep(fmi2Component);
FMI2_Export fmi2Status fmi2GetStatus(fmi2Component, const fmi2StatusKind, fmi2Status *);
FMI2_Export fmi2Status fmi2GetRealStatus(fmi2Component, const fmi2StatusKind, fmi2Real *);
FMI2_Export fmi2Status fmi2GetIntegerStatus(fmi2Component, const fmi2StatusKind, fmi2Integer *);
FMI2_Export fmi2Status fmi2GetBooleanStatus(fmi2Component, const fmi2StatusKind, fmi2Boolean *);
FMI2_Export fmi2Status fmi2GetStringStatus(fmi2Component, const fmi2StatusKind, fmi2String *);

#endif
