/* The FMI 3.0 face: saved states, dependencies and partial derivatives. */
#include "fmi3Functions.h"

#include <stdlib.h>

#define FMI_STATUS fmi3Status
#include "face.h"

fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState *state) {
    INSTANCE(instance, MODES_ANY);
    REQUIRE(state);
    return (fmi3Status)instance_save(I, (SavedState **)state);
}

fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState state) {
    INSTANCE(instance, MODES_ANY);
    REQUIRE(state);
    return (fmi3Status)instance_restore(I, state);
}

fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState *state) {
    INSTANCE(instance, MODES_ANY);
    if (state) {
        free(*state);
        *state = NULL;
    }
    return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState state, size_t *size) {
    INSTANCE(instance, MODES_ANY);
    REQUIRE(state);
    REQUIRE(size);
    *size = state_size(state);
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState state, fmi3Byte bytes[], size_t size) {
    INSTANCE(instance, MODES_ANY);
    REQUIRE(state);
    REQUIRE(bytes);
    return (fmi3Status)state_serialize(I, state, (unsigned char *)bytes, size);
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance instance, const fmi3Byte bytes[], size_t size, fmi3FMUState *state) {
    INSTANCE(instance, MODES_ANY);
    REQUIRE(bytes);
    REQUIRE(state);
    return (fmi3Status)state_deserialize(I, (const unsigned char *)bytes, size, (SavedState **)state);
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[], size_t n_unknowns,
                                        const fmi3ValueReference knowns[], size_t n_knowns, const fmi3Float64 seed[],
                                        size_t n_seed, fmi3Float64 sensitivity[], size_t n_sensitivity) {
    INSTANCE(instance, MODES_EVALUATE);
    REQUIRE(unknowns);
    REQUIRE(knowns);
    REQUIRE(seed);
    REQUIRE(sensitivity);
    if (n_seed != n_knowns * I->robots || n_sensitivity != n_unknowns * I->robots) REFUSE("array sizes do not fit");
    const Partials partials = {unknowns, knowns, n_unknowns, n_knowns};
    return (fmi3Status)instance_directional(I, &partials, seed, sensitivity, __func__);
}

fmi3Status fmi3GetAdjointDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[], size_t n_unknowns,
                                    const fmi3ValueReference knowns[], size_t n_knowns, const fmi3Float64 seed[],
                                    size_t n_seed, fmi3Float64 sensitivity[], size_t n_sensitivity) {
    INSTANCE(instance, MODES_EVALUATE);
    REQUIRE(unknowns);
    REQUIRE(knowns);
    REQUIRE(seed);
    REQUIRE(sensitivity);
    if (n_seed != n_unknowns * I->robots || n_sensitivity != n_knowns * I->robots) REFUSE("array sizes do not fit");
    const Partials partials = {unknowns, knowns, n_unknowns, n_knowns};
    return (fmi3Status)instance_adjoint(I, &partials, seed, sensitivity, __func__);
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
