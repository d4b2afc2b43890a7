/* The FMI 3.0 face: clocks, of which the model has none. */
#include "fmi3Functions.h"

#define FMI_STATUS fmi3Status
#include "face.h"

#define NO_CLOCKS                                                                                                      \
    UNUSED(references);                                                                                                \
    INSTANCE(instance, MODES_ANY);                                                                                     \
    if (count) REFUSE("the model has no clocks");                                                                      \
    return fmi3OK

fmi3Status fmi3GetClock(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                        fmi3Clock values[]) {
    UNUSED(values);
    NO_CLOCKS;
}

fmi3Status fmi3SetClock(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                        const fmi3Clock values[]) {
    UNUSED(values);
    NO_CLOCKS;
}

fmi3Status fmi3GetIntervalDecimal(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                                  fmi3Float64 intervals[], fmi3IntervalQualifier qualifiers[]) {
    UNUSED(intervals);
    UNUSED(qualifiers);
    NO_CLOCKS;
}

fmi3Status fmi3GetIntervalFraction(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                                   fmi3UInt64 counters[], fmi3UInt64 resolutions[],
                                   fmi3IntervalQualifier qualifiers[]) {
    UNUSED(counters);
    UNUSED(resolutions);
    UNUSED(qualifiers);
    NO_CLOCKS;
}

fmi3Status fmi3GetShiftDecimal(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                               fmi3Float64 shifts[]) {
    UNUSED(shifts);
    NO_CLOCKS;
}

fmi3Status fmi3GetShiftFraction(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                                fmi3UInt64 counters[], fmi3UInt64 resolutions[]) {
    UNUSED(counters);
    UNUSED(resolutions);
    NO_CLOCKS;
}

fmi3Status fmi3SetIntervalDecimal(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                                  const fmi3Float64 intervals[]) {
    UNUSED(intervals);
    NO_CLOCKS;
}

fmi3Status fmi3SetIntervalFraction(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                                   const fmi3UInt64 counters[], const fmi3UInt64 resolutions[]) {
    UNUSED(counters);
    UNUSED(resolutions);
    NO_CLOCKS;
}

fmi3Status fmi3SetShiftDecimal(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                               const fmi3Float64 shifts[]) {
    UNUSED(shifts);
    NO_CLOCKS;
}

fmi3Status fmi3SetShiftFraction(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                                const fmi3UInt64 counters[], const fmi3UInt64 resolutions[]) {
    UNUSED(counters);
    UNUSED(resolutions);
    NO_CLOCKS;
}
