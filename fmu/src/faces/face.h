/* What the FMI faces share. Each defines FMI_STATUS, its own type with the numbers of Status, before including this. */
#ifndef LAGLAB_FACE_H
#define LAGLAB_FACE_H

#include "instance.h"

#define UNUSED(argument) (void)(argument)

/* Names the instance `I`, and ends the call when it is NULL or in none of the `modes`. */
#define INSTANCE(handle, modes)                                                                                        \
    Instance *I = handle;                                                                                              \
    if (!I || !instance_allows(I, modes, __func__)) return (FMI_STATUS)STATUS_ERROR

/* Ends the call when an argument is NULL. */
#define REQUIRE(pointer)                                                                                               \
    if (!(pointer)) return (FMI_STATUS)instance_log(I, STATUS_ERROR, "%s: %s is NULL", __func__, #pointer)

/* Ends the call when it is about no variables; else it needs both arrays. */
#define REQUIRE_VALUES(references, values)                                                                             \
    if (!count) return (FMI_STATUS)STATUS_OK;                                                                          \
    REQUIRE(references);                                                                                               \
    REQUIRE(values)

/* Ends the call for what the model does not have. */
#define REFUSE(why) return (FMI_STATUS)instance_log(I, STATUS_ERROR, "%s: %s", __func__, why)

enum { MODES_EVALUATE = MODE_INITIALIZATION | MODES_RUN | MODE_INTERMEDIATE | MODE_TERMINATED };

#endif
