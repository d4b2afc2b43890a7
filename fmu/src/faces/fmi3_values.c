/* The FMI 3.0 face: getting and setting variables. */
#include "fmi3Functions.h"

#define FMI_STATUS fmi3Status
#include "face.h"

fmi3Status fmi3GetFloat64(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                          fmi3Float64 values[], size_t size) {
    INSTANCE(instance, MODES_READ);
    REQUIRE_VALUES(references, values);
    return (fmi3Status)instance_get_floats(I, references, count, values, size, __func__);
}

fmi3Status fmi3SetFloat64(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                          const fmi3Float64 values[], size_t size) {
    INSTANCE(instance, MODES_ANY);
    REQUIRE_VALUES(references, values);
    return (fmi3Status)instance_set_floats(I, references, count, values, size, __func__);
}

/* Everything is checked before anything is set. */
#define GET_AND_SET(NAME, TYPE, FMI_TYPE)                                                                              \
    fmi3Status fmi3Get##NAME(fmi3Instance instance, const fmi3ValueReference references[], size_t count,               \
                             FMI_TYPE values[], size_t size) {                                                         \
        INSTANCE(instance, MODES_READ);                                                                                \
        REQUIRE_VALUES(references, values);                                                                            \
        const Status status = instance_check_size(I, TYPE, references, count, size, __func__);                         \
        for (size_t i = 0; status == STATUS_OK && i < count; i++) {                                                    \
            const Variable *variable = instance_variable(I, TYPE, references[i], __func__);                            \
            for (size_t k = 0; k < instance_size(I, variable); k++) {                                                  \
                *values++ = (FMI_TYPE)instance_integer(I, variable, k);                                                \
            }                                                                                                          \
        }                                                                                                              \
        return (fmi3Status)status;                                                                                     \
    }                                                                                                                  \
    fmi3Status fmi3Set##NAME(fmi3Instance instance, const fmi3ValueReference references[], size_t count,               \
                             const FMI_TYPE values[], size_t size) {                                                   \
        INSTANCE(instance, MODES_ANY);                                                                                 \
        REQUIRE_VALUES(references, values);                                                                            \
        Status status = instance_check_size(I, TYPE, references, count, size, __func__);                               \
        for (int assign = 0; assign < 2; assign++) {                                                                   \
            const FMI_TYPE *value = values;                                                                            \
            for (size_t i = 0; status == STATUS_OK && i < count; i++) {                                                \
                const Variable *variable = instance_variable(I, TYPE, references[i], __func__);                        \
                for (size_t k = 0; status == STATUS_OK && k < instance_size(I, variable); k++, value++) {              \
                    status = assign ? instance_set_integer(I, variable, k, (int64_t)*value)                            \
                                    : instance_check_integer(I, variable, (double)*value, __func__);                   \
                }                                                                                                      \
            }                                                                                                          \
        }                                                                                                              \
        return (fmi3Status)status;                                                                                     \
    }

GET_AND_SET(Int32, TYPE_INT32, fmi3Int32)
GET_AND_SET(Int64, TYPE_INT64, fmi3Int64)
GET_AND_SET(UInt64, TYPE_UINT64, fmi3UInt64)
GET_AND_SET(Boolean, TYPE_BOOLEAN, fmi3Boolean)

/* Types that no variable has. */
#define NONE(NAME, FMI_TYPE)                                                                                           \
    fmi3Status fmi3Get##NAME(fmi3Instance instance, const fmi3ValueReference references[], size_t count,               \
                             FMI_TYPE values[], size_t size) {                                                         \
        UNUSED(references);                                                                                            \
        UNUSED(values);                                                                                                \
        UNUSED(size);                                                                                                  \
        INSTANCE(instance, MODES_READ);                                                                                \
        if (count) REFUSE("the model has no variables of this type");                                                  \
        return fmi3OK;                                                                                                 \
    }                                                                                                                  \
    fmi3Status fmi3Set##NAME(fmi3Instance instance, const fmi3ValueReference references[], size_t count,               \
                             const FMI_TYPE values[], size_t size) {                                                   \
        UNUSED(references);                                                                                            \
        UNUSED(values);                                                                                                \
        UNUSED(size);                                                                                                  \
        INSTANCE(instance, MODES_ANY);                                                                                 \
        if (count) REFUSE("the model has no variables of this type");                                                  \
        return fmi3OK;                                                                                                 \
    }

NONE(Float32, fmi3Float32)
NONE(Int8, fmi3Int8)
NONE(UInt8, fmi3UInt8)
NONE(Int16, fmi3Int16)
NONE(UInt16, fmi3UInt16)
NONE(UInt32, fmi3UInt32)
NONE(String, fmi3String)

fmi3Status fmi3GetBinary(fmi3Instance instance, const fmi3ValueReference references[], size_t count, size_t sizes[],
                         fmi3Binary values[], size_t size) {
    UNUSED(references);
    UNUSED(sizes);
    UNUSED(values);
    UNUSED(size);
    INSTANCE(instance, MODES_READ);
    if (count) REFUSE("the model has no variables of this type");
    return fmi3OK;
}

fmi3Status fmi3SetBinary(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                         const size_t sizes[], const fmi3Binary values[], size_t size) {
    UNUSED(references);
    UNUSED(sizes);
    UNUSED(values);
    UNUSED(size);
    INSTANCE(instance, MODES_ANY);
    if (count) REFUSE("the model has no variables of this type");
    return fmi3OK;
}
