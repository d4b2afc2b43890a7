/* The FMI 3.0 face: saved states, partial derivatives and dependencies. */
#include "fmi3Functions.h"

#define FMI_STATUS fmi3Status
#include "face.h"

fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState *state) {
    UNUSED(state);
    INSTANCE(instance, MODES_ANY);
    REFUSE("not offered");
}

fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState state) {
    UNUSED(state);
    INSTANCE(instance, MODES_ANY);
    REFUSE("not offered");
}

fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState *state) {
    UNUSED(state);
    INSTANCE(instance, MODES_ANY);
    REFUSE("not offered");
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState state, size_t *size) {
    UNUSED(state);
    UNUSED(size);
    INSTANCE(instance, MODES_ANY);
    REFUSE("not offered");
}

fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState state, fmi3Byte bytes[], size_t size) {
    UNUSED(state);
    UNUSED(bytes);
    UNUSED(size);
    INSTANCE(instance, MODES_ANY);
    REFUSE("not offered");
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance instance, const fmi3Byte bytes[], size_t size, fmi3FMUState *state) {
    UNUSED(state);
    UNUSED(bytes);
    UNUSED(size);
    INSTANCE(instance, MODES_ANY);
    REFUSE("not offered");
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[], size_t n_unknowns,
                                        const fmi3ValueReference knowns[], size_t n_knowns, const fmi3Float64 seed[],
                                        size_t n_seed, fmi3Float64 sensitivity[], size_t n_sensitivity) {
    UNUSED(unknowns);
    UNUSED(n_unknowns);
    UNUSED(knowns);
    UNUSED(n_knowns);
    UNUSED(seed);
    UNUSED(n_seed);
    UNUSED(sensitivity);
    UNUSED(n_sensitivity);
    INSTANCE(instance, MODES_ANY);
    REFUSE("not offered");
}

fmi3Status fmi3GetAdjointDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[], size_t n_unknowns,
                                    const fmi3ValueReference knowns[], size_t n_knowns, const fmi3Float64 seed[],
                                    size_t n_seed, fmi3Float64 sensitivity[], size_t n_sensitivity) {
    UNUSED(unknowns);
    UNUSED(n_unknowns);
    UNUSED(knowns);
    UNUSED(n_knowns);
    UNUSED(seed);
    UNUSED(n_seed);
    UNUSED(sensitivity);
    UNUSED(n_sensitivity);
    INSTANCE(instance, MODES_ANY);
    REFUSE("not offered");
}

fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance instance, fmi3ValueReference reference, size_t *count) {
    UNUSED(reference);
    UNUSED(count);
    INSTANCE(instance, MODES_ANY);
    REFUSE("dependencies are those of the model description");
}

fmi3Status fmi3GetVariableDependencies(fmi3Instance instance, fmi3ValueReference dependent, size_t elements[],
                                       fmi3ValueReference independents[], size_t independent_elements[],
                                       fmi3DependencyKind kinds[], size_t count) {
    UNUSED(dependent);
    UNUSED(elements);
    UNUSED(independents);
    UNUSED(independent_elements);
    UNUSED(kinds);
    UNUSED(count);
    INSTANCE(instance, MODES_ANY);
    REFUSE("dependencies are those of the model description");
}
