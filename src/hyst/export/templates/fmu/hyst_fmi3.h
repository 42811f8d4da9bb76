/* The part of FMI 3.0 that a co-simulation FMU exports: types and functions, declared as the
 * standard has them (https://fmi-standard.org, sections 2.2 and 4.2). */
#ifndef HYST_FMI3_H
#define HYST_FMI3_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define fmi3True true
#define fmi3False false

typedef void *fmi3Instance;
typedef void *fmi3InstanceEnvironment;
typedef void *fmi3FMUState;
typedef uint32_t fmi3ValueReference;
typedef float fmi3Float32;
typedef double fmi3Float64;
typedef int8_t fmi3Int8;
typedef uint8_t fmi3UInt8;
typedef int16_t fmi3Int16;
typedef uint16_t fmi3UInt16;
typedef int32_t fmi3Int32;
typedef uint32_t fmi3UInt32;
typedef int64_t fmi3Int64;
typedef uint64_t fmi3UInt64;
typedef bool fmi3Boolean;
typedef char fmi3Char;
typedef const fmi3Char *fmi3String;
typedef uint8_t fmi3Byte;
typedef const fmi3Byte *fmi3Binary;
typedef bool fmi3Clock;

typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef enum {
    fmi3Independent,
    fmi3Constant,
    fmi3Fixed,
    fmi3Tunable,
    fmi3Discrete,
    fmi3Dependent
} fmi3DependencyKind;
typedef enum {
    fmi3IntervalNotYetKnown,
    fmi3IntervalUnchanged,
    fmi3IntervalChanged
} fmi3IntervalQualifier;

typedef void (*fmi3LogMessageCallback)(fmi3InstanceEnvironment, fmi3Status, fmi3String category,
                                       fmi3String message);
typedef void (*fmi3ClockUpdateCallback)(fmi3InstanceEnvironment);
typedef void (*fmi3IntermediateUpdateCallback)(fmi3InstanceEnvironment, fmi3Float64 time,
                                               fmi3Boolean setRequested, fmi3Boolean getAllowed,
                                               fmi3Boolean stepFinished, fmi3Boolean canReturnEarly,
                                               fmi3Boolean *earlyReturnRequested,
                                               fmi3Float64 *earlyReturnTime);
typedef void (*fmi3LockPreemptionCallback)(void);
typedef void (*fmi3UnlockPreemptionCallback)(void);

#if defined(FMI3_FUNCTION_PREFIX) && !defined(FMI3_OVERRIDE_FUNCTION_PREFIX)
#define HYST_FMI3_PASTE(a, b) a##b
#define HYST_FMI3_JOIN(a, b) HYST_FMI3_PASTE(a, b)
#define HYST_FMI3_NAME(name) HYST_FMI3_JOIN(FMI3_FUNCTION_PREFIX, name)
#define fmi3GetVersion HYST_FMI3_NAME(fmi3GetVersion)
#define fmi3SetDebugLogging HYST_FMI3_NAME(fmi3SetDebugLogging)
#define fmi3InstantiateModelExchange HYST_FMI3_NAME(fmi3InstantiateModelExchange)
#define fmi3InstantiateCoSimulation HYST_FMI3_NAME(fmi3InstantiateCoSimulation)
#define fmi3InstantiateScheduledExecution HYST_FMI3_NAME(fmi3InstantiateScheduledExecution)
#define fmi3FreeInstance HYST_FMI3_NAME(fmi3FreeInstance)
#define fmi3EnterInitializationMode HYST_FMI3_NAME(fmi3EnterInitializationMode)
#define fmi3ExitInitializationMode HYST_FMI3_NAME(fmi3ExitInitializationMode)
#define fmi3EnterEventMode HYST_FMI3_NAME(fmi3EnterEventMode)
#define fmi3Terminate HYST_FMI3_NAME(fmi3Terminate)
#define fmi3Reset HYST_FMI3_NAME(fmi3Reset)
#define fmi3GetFloat32 HYST_FMI3_NAME(fmi3GetFloat32)
#define fmi3GetFloat64 HYST_FMI3_NAME(fmi3GetFloat64)
#define fmi3GetInt8 HYST_FMI3_NAME(fmi3GetInt8)
#define fmi3GetUInt8 HYST_FMI3_NAME(fmi3GetUInt8)
#define fmi3GetInt16 HYST_FMI3_NAME(fmi3GetInt16)
#define fmi3GetUInt16 HYST_FMI3_NAME(fmi3GetUInt16)
#define fmi3GetInt32 HYST_FMI3_NAME(fmi3GetInt32)
#define fmi3GetUInt32 HYST_FMI3_NAME(fmi3GetUInt32)
#define fmi3GetInt64 HYST_FMI3_NAME(fmi3GetInt64)
#define fmi3GetUInt64 HYST_FMI3_NAME(fmi3GetUInt64)
#define fmi3GetBoolean HYST_FMI3_NAME(fmi3GetBoolean)
#define fmi3GetString HYST_FMI3_NAME(fmi3GetString)
#define fmi3GetBinary HYST_FMI3_NAME(fmi3GetBinary)
#define fmi3GetClock HYST_FMI3_NAME(fmi3GetClock)
#define fmi3SetFloat32 HYST_FMI3_NAME(fmi3SetFloat32)
#define fmi3SetFloat64 HYST_FMI3_NAME(fmi3SetFloat64)
#define fmi3SetInt8 HYST_FMI3_NAME(fmi3SetInt8)
#define fmi3SetUInt8 HYST_FMI3_NAME(fmi3SetUInt8)
#define fmi3SetInt16 HYST_FMI3_NAME(fmi3SetInt16)
#define fmi3SetUInt16 HYST_FMI3_NAME(fmi3SetUInt16)
#define fmi3SetInt32 HYST_FMI3_NAME(fmi3SetInt32)
#define fmi3SetUInt32 HYST_FMI3_NAME(fmi3SetUInt32)
#define fmi3SetInt64 HYST_FMI3_NAME(fmi3SetInt64)
#define fmi3SetUInt64 HYST_FMI3_NAME(fmi3SetUInt64)
#define fmi3SetBoolean HYST_FMI3_NAME(fmi3SetBoolean)
#define fmi3SetString HYST_FMI3_NAME(fmi3SetString)
#define fmi3SetBinary HYST_FMI3_NAME(fmi3SetBinary)
#define fmi3SetClock HYST_FMI3_NAME(fmi3SetClock)
#define fmi3GetNumberOfVariableDependencies HYST_FMI3_NAME(fmi3GetNumberOfVariableDependencies)
#define fmi3GetVariableDependencies HYST_FMI3_NAME(fmi3GetVariableDependencies)
#define fmi3GetFMUState HYST_FMI3_NAME(fmi3GetFMUState)
#define fmi3SetFMUState HYST_FMI3_NAME(fmi3SetFMUState)
#define fmi3FreeFMUState HYST_FMI3_NAME(fmi3FreeFMUState)
#define fmi3SerializedFMUStateSize HYST_FMI3_NAME(fmi3SerializedFMUStateSize)
#define fmi3SerializeFMUState HYST_FMI3_NAME(fmi3SerializeFMUState)
#define fmi3DeserializeFMUState HYST_FMI3_NAME(fmi3DeserializeFMUState)
#define fmi3GetDirectionalDerivative HYST_FMI3_NAME(fmi3GetDirectionalDerivative)
#define fmi3GetAdjointDerivative HYST_FMI3_NAME(fmi3GetAdjointDerivative)
#define fmi3EnterConfigurationMode HYST_FMI3_NAME(fmi3EnterConfigurationMode)
#define fmi3ExitConfigurationMode HYST_FMI3_NAME(fmi3ExitConfigurationMode)
#define fmi3GetIntervalDecimal HYST_FMI3_NAME(fmi3GetIntervalDecimal)
#define fmi3GetIntervalFraction HYST_FMI3_NAME(fmi3GetIntervalFraction)
#define fmi3GetShiftDecimal HYST_FMI3_NAME(fmi3GetShiftDecimal)
#define fmi3GetShiftFraction HYST_FMI3_NAME(fmi3GetShiftFraction)
#define fmi3SetIntervalDecimal HYST_FMI3_NAME(fmi3SetIntervalDecimal)
#define fmi3SetIntervalFraction HYST_FMI3_NAME(fmi3SetIntervalFraction)
#define fmi3SetShiftDecimal HYST_FMI3_NAME(fmi3SetShiftDecimal)
#define fmi3SetShiftFraction HYST_FMI3_NAME(fmi3SetShiftFraction)
#define fmi3EvaluateDiscreteStates HYST_FMI3_NAME(fmi3EvaluateDiscreteStates)
#define fmi3UpdateDiscreteStates HYST_FMI3_NAME(fmi3UpdateDiscreteStates)
#define fmi3EnterStepMode HYST_FMI3_NAME(fmi3EnterStepMode)
#define fmi3GetOutputDerivatives HYST_FMI3_NAME(fmi3GetOutputDerivatives)
#define fmi3DoStep HYST_FMI3_NAME(fmi3DoStep)
#define fmi3EnterContinuousTimeMode HYST_FMI3_NAME(fmi3EnterContinuousTimeMode)
#define fmi3CompletedIntegratorStep HYST_FMI3_NAME(fmi3CompletedIntegratorStep)
#define fmi3SetTime HYST_FMI3_NAME(fmi3SetTime)
#define fmi3SetContinuousStates HYST_FMI3_NAME(fmi3SetContinuousStates)
#define fmi3GetContinuousStateDerivatives HYST_FMI3_NAME(fmi3GetContinuousStateDerivatives)
#define fmi3GetEventIndicators HYST_FMI3_NAME(fmi3GetEventIndicators)
#define fmi3GetContinuousStates HYST_FMI3_NAME(fmi3GetContinuousStates)
#define fmi3GetNominalsOfContinuousStates HYST_FMI3_NAME(fmi3GetNominalsOfContinuousStates)
#define fmi3GetNumberOfEventIndicators HYST_FMI3_NAME(fmi3GetNumberOfEventIndicators)
#define fmi3GetNumberOfContinuousStates HYST_FMI3_NAME(fmi3GetNumberOfContinuousStates)
#define fmi3ActivateModelPartition HYST_FMI3_NAME(fmi3ActivateModelPartition)
#endif

#ifndef FMI3_Export
#if defined(FMI3_FUNCTION_PREFIX) && !defined(FMI3_OVERRIDE_FUNCTION_PREFIX)
#define FMI3_Export
#elif defined(_WIN32) || defined(__CYGWIN__)
#define FMI3_Export __declspec(dllexport)
#elif defined(__GNUC__)
#define FMI3_Export __attribute__((visibility("default")))
#else
#define FMI3_Export
#endif
#endif

FMI3_Export const char *fmi3GetVersion(void);
FMI3_Export fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean loggingOn,
                                           size_t nCategories, const fmi3String categories[]);
FMI3_Export fmi3Instance fmi3InstantiateModelExchange(fmi3String instanceName,
                                                      fmi3String instantiationToken,
                                                      fmi3String resourcePath, fmi3Boolean visible,
                                                      fmi3Boolean loggingOn,
                                                      fmi3InstanceEnvironment instanceEnvironment,
                                                      fmi3LogMessageCallback logMessage);
FMI3_Export fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath,
    fmi3Boolean visible, fmi3Boolean loggingOn, fmi3Boolean eventModeUsed,
    fmi3Boolean earlyReturnAllowed, const fmi3ValueReference requiredIntermediateVariables[],
    size_t nRequiredIntermediateVariables, fmi3InstanceEnvironment instanceEnvironment,
    fmi3LogMessageCallback logMessage, fmi3IntermediateUpdateCallback intermediateUpdate);
FMI3_Export fmi3Instance fmi3InstantiateScheduledExecution(
    fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath,
    fmi3Boolean visible, fmi3Boolean loggingOn, fmi3InstanceEnvironment instanceEnvironment,
    fmi3LogMessageCallback logMessage, fmi3ClockUpdateCallback clockUpdate,
    fmi3LockPreemptionCallback lockPreemption, fmi3UnlockPreemptionCallback unlockPreemption);
FMI3_Export void fmi3FreeInstance(fmi3Instance instance);
FMI3_Export fmi3Status fmi3EnterInitializationMode(fmi3Instance instance,
                                                   fmi3Boolean toleranceDefined,
                                                   fmi3Float64 tolerance, fmi3Float64 startTime,
                                                   fmi3Boolean stopTimeDefined,
                                                   fmi3Float64 stopTime);
FMI3_Export fmi3Status fmi3ExitInitializationMode(fmi3Instance instance);
FMI3_Export fmi3Status fmi3EnterEventMode(fmi3Instance instance);
FMI3_Export fmi3Status fmi3Terminate(fmi3Instance instance);
FMI3_Export fmi3Status fmi3Reset(fmi3Instance instance);
FMI3_Export fmi3Status fmi3GetFloat32(fmi3Instance instance,
                                      const fmi3ValueReference valueReferences[],
                                      size_t nValueReferences, fmi3Float32 values[],
                                      size_t nValues);
FMI3_Export fmi3Status fmi3GetFloat64(fmi3Instance instance,
                                      const fmi3ValueReference valueReferences[],
                                      size_t nValueReferences, fmi3Float64 values[],
                                      size_t nValues);
FMI3_Export fmi3Status fmi3GetInt8(fmi3Instance instance,
                                   const fmi3ValueReference valueReferences[],
                                   size_t nValueReferences, fmi3Int8 values[], size_t nValues);
FMI3_Export fmi3Status fmi3GetUInt8(fmi3Instance instance,
                                    const fmi3ValueReference valueReferences[],
                                    size_t nValueReferences, fmi3UInt8 values[], size_t nValues);
FMI3_Export fmi3Status fmi3GetInt16(fmi3Instance instance,
                                    const fmi3ValueReference valueReferences[],
                                    size_t nValueReferences, fmi3Int16 values[], size_t nValues);
FMI3_Export fmi3Status fmi3GetUInt16(fmi3Instance instance,
                                     const fmi3ValueReference valueReferences[],
                                     size_t nValueReferences, fmi3UInt16 values[], size_t nValues);
FMI3_Export fmi3Status fmi3GetInt32(fmi3Instance instance,
                                    const fmi3ValueReference valueReferences[],
                                    size_t nValueReferences, fmi3Int32 values[], size_t nValues);
FMI3_Export fmi3Status fmi3GetUInt32(fmi3Instance instance,
                                     const fmi3ValueReference valueReferences[],
                                     size_t nValueReferences, fmi3UInt32 values[], size_t nValues);
FMI3_Export fmi3Status fmi3GetInt64(fmi3Instance instance,
                                    const fmi3ValueReference valueReferences[],
                                    size_t nValueReferences, fmi3Int64 values[], size_t nValues);
FMI3_Export fmi3Status fmi3GetUInt64(fmi3Instance instance,
                                     const fmi3ValueReference valueReferences[],
                                     size_t nValueReferences, fmi3UInt64 values[], size_t nValues);
FMI3_Export fmi3Status fmi3GetBoolean(fmi3Instance instance,
                                      const fmi3ValueReference valueReferences[],
                                      size_t nValueReferences, fmi3Boolean values[],
                                      size_t nValues);
FMI3_Export fmi3Status fmi3GetString(fmi3Instance instance,
                                     const fmi3ValueReference valueReferences[],
                                     size_t nValueReferences, fmi3String values[], size_t nValues);
FMI3_Export fmi3Status fmi3GetBinary(fmi3Instance instance,
                                     const fmi3ValueReference valueReferences[],
                                     size_t nValueReferences, size_t valueSizes[],
                                     fmi3Binary values[], size_t nValues);
FMI3_Export fmi3Status fmi3GetClock(fmi3Instance instance,
                                    const fmi3ValueReference valueReferences[],
                                    size_t nValueReferences, fmi3Clock values[]);
FMI3_Export fmi3Status fmi3SetFloat32(fmi3Instance instance,
                                      const fmi3ValueReference valueReferences[],
                                      size_t nValueReferences, const fmi3Float32 values[],
                                      size_t nValues);
FMI3_Export fmi3Status fmi3SetFloat64(fmi3Instance instance,
                                      const fmi3ValueReference valueReferences[],
                                      size_t nValueReferences, const fmi3Float64 values[],
                                      size_t nValues);
FMI3_Export fmi3Status fmi3SetInt8(fmi3Instance instance,
                                   const fmi3ValueReference valueReferences[],
                                   size_t nValueReferences, const fmi3Int8 values[],
                                   size_t nValues);
FMI3_Export fmi3Status fmi3SetUInt8(fmi3Instance instance,
                                    const fmi3ValueReference valueReferences[],
                                    size_t nValueReferences, const fmi3UInt8 values[],
                                    size_t nValues);
FMI3_Export fmi3Status fmi3SetInt16(fmi3Instance instance,
                                    const fmi3ValueReference valueReferences[],
                                    size_t nValueReferences, const fmi3Int16 values[],
                                    size_t nValues);
FMI3_Export fmi3Status fmi3SetUInt16(fmi3Instance instance,
                                     const fmi3ValueReference valueReferences[],
                                     size_t nValueReferences, const fmi3UInt16 values[],
                                     size_t nValues);
FMI3_Export fmi3Status fmi3SetInt32(fmi3Instance instance,
                                    const fmi3ValueReference valueReferences[],
                                    size_t nValueReferences, const fmi3Int32 values[],
                                    size_t nValues);
FMI3_Export fmi3Status fmi3SetUInt32(fmi3Instance instance,
                                     const fmi3ValueReference valueReferences[],
                                     size_t nValueReferences, const fmi3UInt32 values[],
                                     size_t nValues);
FMI3_Export fmi3Status fmi3SetInt64(fmi3Instance instance,
                                    const fmi3ValueReference valueReferences[],
                                    size_t nValueReferences, const fmi3Int64 values[],
                                    size_t nValues);
FMI3_Export fmi3Status fmi3SetUInt64(fmi3Instance instance,
                                     const fmi3ValueReference valueReferences[],
                                     size_t nValueReferences, const fmi3UInt64 values[],
                                     size_t nValues);
FMI3_Export fmi3Status fmi3SetBoolean(fmi3Instance instance,
                                      const fmi3ValueReference valueReferences[],
                                      size_t nValueReferences, const fmi3Boolean values[],
                                      size_t nValues);
FMI3_Export fmi3Status fmi3SetString(fmi3Instance instance,
                                     const fmi3ValueReference valueReferences[],
                                     size_t nValueReferences, const fmi3String values[],
                                     size_t nValues);
FMI3_Export fmi3Status fmi3SetBinary(fmi3Instance instance,
                                     const fmi3ValueReference valueReferences[],
                                     size_t nValueReferences, const size_t valueSizes[],
                                     const fmi3Binary values[], size_t nValues);
FMI3_Export fmi3Status fmi3SetClock(fmi3Instance instance,
                                    const fmi3ValueReference valueReferences[],
                                    size_t nValueReferences, const fmi3Clock values[]);
FMI3_Export fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance instance,
                                                           fmi3ValueReference valueReference,
                                                           size_t *nDependencies);
FMI3_Export fmi3Status fmi3GetVariableDependencies(
    fmi3Instance instance, fmi3ValueReference dependent, size_t elementIndicesOfDependent[],
    fmi3ValueReference independents[], size_t elementIndicesOfIndependents[],
    fmi3DependencyKind dependencyKinds[], size_t nDependencies);
FMI3_Export fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState *FMUState);
FMI3_Export fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState FMUState);
FMI3_Export fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState *FMUState);
FMI3_Export fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState FMUState,
                                                  size_t *size);
FMI3_Export fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState FMUState,
                                             fmi3Byte serializedState[], size_t size);
FMI3_Export fmi3Status fmi3DeserializeFMUState(fmi3Instance instance,
                                               const fmi3Byte serializedState[], size_t size,
                                               fmi3FMUState *FMUState);
FMI3_Export fmi3Status fmi3GetDirectionalDerivative(
    fmi3Instance instance, const fmi3ValueReference unknowns[], size_t nUnknowns,
    const fmi3ValueReference knowns[], size_t nKnowns, const fmi3Float64 seed[], size_t nSeed,
    fmi3Float64 sensitivity[], size_t nSensitivity);
FMI3_Export fmi3Status fmi3GetAdjointDerivative(fmi3Instance instance,
                                                const fmi3ValueReference unknowns[],
                                                size_t nUnknowns, const fmi3ValueReference knowns[],
                                                size_t nKnowns, const fmi3Float64 seed[],
                                                size_t nSeed, fmi3Float64 sensitivity[],
                                                size_t nSensitivity);
FMI3_Export fmi3Status fmi3EnterConfigurationMode(fmi3Instance instance);
FMI3_Export fmi3Status fmi3ExitConfigurationMode(fmi3Instance instance);
FMI3_Export fmi3Status fmi3GetIntervalDecimal(fmi3Instance instance,
                                              const fmi3ValueReference valueReferences[],
                                              size_t nValueReferences, fmi3Float64 intervals[],
                                              fmi3IntervalQualifier qualifiers[]);
FMI3_Export fmi3Status fmi3GetIntervalFraction(fmi3Instance instance,
                                               const fmi3ValueReference valueReferences[],
                                               size_t nValueReferences, fmi3UInt64 counters[],
                                               fmi3UInt64 resolutions[],
                                               fmi3IntervalQualifier qualifiers[]);
FMI3_Export fmi3Status fmi3GetShiftDecimal(fmi3Instance instance,
                                           const fmi3ValueReference valueReferences[],
                                           size_t nValueReferences, fmi3Float64 shifts[]);
FMI3_Export fmi3Status fmi3GetShiftFraction(fmi3Instance instance,
                                            const fmi3ValueReference valueReferences[],
                                            size_t nValueReferences, fmi3UInt64 counters[],
                                            fmi3UInt64 resolutions[]);
FMI3_Export fmi3Status fmi3SetIntervalDecimal(fmi3Instance instance,
                                              const fmi3ValueReference valueReferences[],
                                              size_t nValueReferences,
                                              const fmi3Float64 intervals[]);
FMI3_Export fmi3Status fmi3SetIntervalFraction(fmi3Instance instance,
                                               const fmi3ValueReference valueReferences[],
                                               size_t nValueReferences, const fmi3UInt64 counters[],
                                               const fmi3UInt64 resolutions[]);
FMI3_Export fmi3Status fmi3SetShiftDecimal(fmi3Instance instance,
                                           const fmi3ValueReference valueReferences[],
                                           size_t nValueReferences, const fmi3Float64 shifts[]);
FMI3_Export fmi3Status fmi3SetShiftFraction(fmi3Instance instance,
                                            const fmi3ValueReference valueReferences[],
                                            size_t nValueReferences, const fmi3UInt64 counters[],
                                            const fmi3UInt64 resolutions[]);
FMI3_Export fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance instance);
FMI3_Export fmi3Status fmi3UpdateDiscreteStates(
    fmi3Instance instance, fmi3Boolean *discreteStatesNeedUpdate, fmi3Boolean *terminateSimulation,
    fmi3Boolean *nominalsOfContinuousStatesChanged, fmi3Boolean *valuesOfContinuousStatesChanged,
    fmi3Boolean *nextEventTimeDefined, fmi3Float64 *nextEventTime);
FMI3_Export fmi3Status fmi3EnterStepMode(fmi3Instance instance);
FMI3_Export fmi3Status fmi3GetOutputDerivatives(fmi3Instance instance,
                                                const fmi3ValueReference valueReferences[],
                                                size_t nValueReferences, const fmi3Int32 orders[],
                                                fmi3Float64 values[], size_t nValues);
FMI3_Export fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 currentCommunicationPoint,
                                  fmi3Float64 communicationStepSize,
                                  fmi3Boolean noSetFMUStatePriorToCurrentPoint,
                                  fmi3Boolean *eventHandlingNeeded,
                                  fmi3Boolean *terminateSimulation, fmi3Boolean *earlyReturn,
                                  fmi3Float64 *lastSuccessfulTime);
FMI3_Export fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance instance);
FMI3_Export fmi3Status fmi3CompletedIntegratorStep(fmi3Instance instance,
                                                   fmi3Boolean noSetFMUStatePriorToCurrentPoint,
                                                   fmi3Boolean *enterEventMode,
                                                   fmi3Boolean *terminateSimulation);
FMI3_Export fmi3Status fmi3SetTime(fmi3Instance instance, fmi3Float64 time);
FMI3_Export fmi3Status fmi3SetContinuousStates(fmi3Instance instance,
                                               const fmi3Float64 continuousStates[],
                                               size_t nContinuousStates);
FMI3_Export fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance instance,
                                                         fmi3Float64 derivatives[],
                                                         size_t nContinuousStates);
FMI3_Export fmi3Status fmi3GetEventIndicators(fmi3Instance instance, fmi3Float64 eventIndicators[],
                                              size_t nEventIndicators);
FMI3_Export fmi3Status fmi3GetContinuousStates(fmi3Instance instance,
                                               fmi3Float64 continuousStates[],
                                               size_t nContinuousStates);
FMI3_Export fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance instance,
                                                         fmi3Float64 nominals[],
                                                         size_t nContinuousStates);
FMI3_Export fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance instance,
                                                      size_t *nEventIndicators);
FMI3_Export fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance instance,
                                                       size_t *nContinuousStates);
FMI3_Export fmi3Status fmi3ActivateModelPartition(fmi3Instance instance,
                                                  fmi3ValueReference clockReference,
                                                  fmi3Float64 activationTime);

#endif
