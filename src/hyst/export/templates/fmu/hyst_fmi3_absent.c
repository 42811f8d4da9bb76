/* FMI 3.0: functions for what the FMU does not have, which every FMU exports all the same. */

static fmi3Status hyst_fmi3_no_variable(fmi3Instance instance, size_t count)
{
    if (instance != NULL && count == 0) {
        return fmi3OK;
    }
    return hyst_fmi3_none(instance, "there is no variable of this type that can be had so; inputs, "
                                    "output and parameters are Float64, fault is UInt32");
}

#define HYST_FMI3_NO_GET(type)                                                                  \
    fmi3Status fmi3Get##type(fmi3Instance instance, const fmi3ValueReference valueReferences[], \
                             size_t nValueReferences, fmi3##type values[], size_t nValues)      \
    {                                                                                           \
        (void)valueReferences;                                                                  \
        (void)values;                                                                           \
        (void)nValues;                                                                          \
        return hyst_fmi3_no_variable(instance, nValueReferences);                               \
    }

#define HYST_FMI3_NO_SET(type)                                                                   \
    fmi3Status fmi3Set##type(fmi3Instance instance, const fmi3ValueReference valueReferences[],  \
                             size_t nValueReferences, const fmi3##type values[], size_t nValues) \
    {                                                                                            \
        (void)valueReferences;                                                                   \
        (void)values;                                                                            \
        (void)nValues;                                                                           \
        return hyst_fmi3_no_variable(instance, nValueReferences);                                \
    }

HYST_FMI3_NO_GET(Float32)
HYST_FMI3_NO_GET(Int8)
HYST_FMI3_NO_GET(UInt8)
HYST_FMI3_NO_GET(Int16)
HYST_FMI3_NO_GET(UInt16)
HYST_FMI3_NO_GET(Int32)
HYST_FMI3_NO_GET(Int64)
HYST_FMI3_NO_GET(UInt64)
HYST_FMI3_NO_GET(Boolean)
HYST_FMI3_NO_GET(String)
HYST_FMI3_NO_SET(Float32)
HYST_FMI3_NO_SET(Int8)
HYST_FMI3_NO_SET(UInt8)
HYST_FMI3_NO_SET(Int16)
HYST_FMI3_NO_SET(UInt16)
HYST_FMI3_NO_SET(Int32)
HYST_FMI3_NO_SET(UInt32)
HYST_FMI3_NO_SET(Int64)
HYST_FMI3_NO_SET(UInt64)
HYST_FMI3_NO_SET(Boolean)
HYST_FMI3_NO_SET(String)

fmi3Status fmi3EnterEventMode(fmi3Instance instance)
{
    return hyst_fmi3_none(instance, "there are no events; the FMU has no event mode");
}

fmi3Status fmi3GetBinary(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                         size_t nValueReferences, size_t valueSizes[], fmi3Binary values[],
                         size_t nValues)
{
    (void)valueReferences;
    (void)valueSizes;
    (void)values;
    (void)nValues;
    return hyst_fmi3_no_variable(instance, nValueReferences);
}

fmi3Status fmi3GetClock(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                        size_t nValueReferences, fmi3Clock values[])
{
    (void)valueReferences;
    (void)values;
    return hyst_fmi3_no_variable(instance, nValueReferences);
}

fmi3Status fmi3SetBinary(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                         size_t nValueReferences, const size_t valueSizes[],
                         const fmi3Binary values[], size_t nValues)
{
    (void)valueReferences;
    (void)valueSizes;
    (void)values;
    (void)nValues;
    return hyst_fmi3_no_variable(instance, nValueReferences);
}

fmi3Status fmi3SetClock(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                        size_t nValueReferences, const fmi3Clock values[])
{
    (void)valueReferences;
    (void)values;
    return hyst_fmi3_no_variable(instance, nValueReferences);
}

fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance instance,
                                               fmi3ValueReference valueReference,
                                               size_t *nDependencies)
{
    (void)valueReference;
    (void)nDependencies;
    return hyst_fmi3_none(instance, "the dependencies are those of modelDescription.xml");
}

fmi3Status fmi3GetVariableDependencies(fmi3Instance instance, fmi3ValueReference dependent,
                                       size_t elementIndicesOfDependent[],
                                       fmi3ValueReference independents[],
                                       size_t elementIndicesOfIndependents[],
                                       fmi3DependencyKind dependencyKinds[], size_t nDependencies)
{
    (void)dependent;
    (void)elementIndicesOfDependent;
    (void)independents;
    (void)elementIndicesOfIndependents;
    (void)dependencyKinds;
    (void)nDependencies;
    return hyst_fmi3_none(instance, "the dependencies are those of modelDescription.xml");
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[],
                                        size_t nUnknowns, const fmi3ValueReference knowns[],
                                        size_t nKnowns, const fmi3Float64 seed[], size_t nSeed,
                                        fmi3Float64 sensitivity[], size_t nSensitivity)
{
    (void)unknowns;
    (void)nUnknowns;
    (void)knowns;
    (void)nKnowns;
    (void)seed;
    (void)nSeed;
    (void)sensitivity;
    (void)nSensitivity;
    return hyst_fmi3_none(instance, "the FMU provides no derivatives");
}

fmi3Status fmi3GetAdjointDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[],
                                    size_t nUnknowns, const fmi3ValueReference knowns[],
                                    size_t nKnowns, const fmi3Float64 seed[], size_t nSeed,
                                    fmi3Float64 sensitivity[], size_t nSensitivity)
{
    (void)unknowns;
    (void)nUnknowns;
    (void)knowns;
    (void)nKnowns;
    (void)seed;
    (void)nSeed;
    (void)sensitivity;
    (void)nSensitivity;
    return hyst_fmi3_none(instance, "the FMU provides no derivatives");
}

fmi3Status fmi3EnterConfigurationMode(fmi3Instance instance)
{
    return hyst_fmi3_none(instance,
                          "there are no structural parameters, and so no configuration mode");
}

fmi3Status fmi3ExitConfigurationMode(fmi3Instance instance)
{
    return hyst_fmi3_none(instance,
                          "there are no structural parameters, and so no configuration mode");
}

fmi3Status fmi3GetIntervalDecimal(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                                  size_t nValueReferences, fmi3Float64 intervals[],
                                  fmi3IntervalQualifier qualifiers[])
{
    (void)valueReferences;
    (void)intervals;
    (void)qualifiers;
    return hyst_fmi3_no_variable(instance, nValueReferences);
}

fmi3Status fmi3GetIntervalFraction(fmi3Instance instance,
                                   const fmi3ValueReference valueReferences[],
                                   size_t nValueReferences, fmi3UInt64 counters[],
                                   fmi3UInt64 resolutions[], fmi3IntervalQualifier qualifiers[])
{
    (void)valueReferences;
    (void)counters;
    (void)resolutions;
    (void)qualifiers;
    return hyst_fmi3_no_variable(instance, nValueReferences);
}

fmi3Status fmi3GetShiftDecimal(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                               size_t nValueReferences, fmi3Float64 shifts[])
{
    (void)valueReferences;
    (void)shifts;
    return hyst_fmi3_no_variable(instance, nValueReferences);
}

fmi3Status fmi3GetShiftFraction(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                                size_t nValueReferences, fmi3UInt64 counters[],
                                fmi3UInt64 resolutions[])
{
    (void)valueReferences;
    (void)counters;
    (void)resolutions;
    return hyst_fmi3_no_variable(instance, nValueReferences);
}

fmi3Status fmi3SetIntervalDecimal(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                                  size_t nValueReferences, const fmi3Float64 intervals[])
{
    (void)valueReferences;
    (void)intervals;
    return hyst_fmi3_no_variable(instance, nValueReferences);
}

fmi3Status fmi3SetIntervalFraction(fmi3Instance instance,
                                   const fmi3ValueReference valueReferences[],
                                   size_t nValueReferences, const fmi3UInt64 counters[],
                                   const fmi3UInt64 resolutions[])
{
    (void)valueReferences;
    (void)counters;
    (void)resolutions;
    return hyst_fmi3_no_variable(instance, nValueReferences);
}

fmi3Status fmi3SetShiftDecimal(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                               size_t nValueReferences, const fmi3Float64 shifts[])
{
    (void)valueReferences;
    (void)shifts;
    return hyst_fmi3_no_variable(instance, nValueReferences);
}

fmi3Status fmi3SetShiftFraction(fmi3Instance instance, const fmi3ValueReference valueReferences[],
                                size_t nValueReferences, const fmi3UInt64 counters[],
                                const fmi3UInt64 resolutions[])
{
    (void)valueReferences;
    (void)counters;
    (void)resolutions;
    return hyst_fmi3_no_variable(instance, nValueReferences);
}

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance instance)
{
    return hyst_fmi3_none(instance, "there are no events; the FMU has no event mode");
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance instance, fmi3Boolean *discreteStatesNeedUpdate,
                                    fmi3Boolean *terminateSimulation,
                                    fmi3Boolean *nominalsOfContinuousStatesChanged,
                                    fmi3Boolean *valuesOfContinuousStatesChanged,
                                    fmi3Boolean *nextEventTimeDefined, fmi3Float64 *nextEventTime)
{
    (void)discreteStatesNeedUpdate;
    (void)terminateSimulation;
    (void)nominalsOfContinuousStatesChanged;
    (void)valuesOfContinuousStatesChanged;
    (void)nextEventTimeDefined;
    (void)nextEventTime;
    return hyst_fmi3_none(instance, "there are no events; the FMU has no event mode");
}

fmi3Status fmi3EnterStepMode(fmi3Instance instance)
{
    return hyst_fmi3_none(instance,
                          "there are no events; the FMU is in step mode once initialized");
}

fmi3Status fmi3GetOutputDerivatives(fmi3Instance instance,
                                    const fmi3ValueReference valueReferences[],
                                    size_t nValueReferences, const fmi3Int32 orders[],
                                    fmi3Float64 values[], size_t nValues)
{
    (void)valueReferences;
    (void)nValueReferences;
    (void)orders;
    (void)values;
    (void)nValues;
    return hyst_fmi3_none(instance, "the FMU provides no derivatives of its output");
}
