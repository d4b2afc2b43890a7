/* One instance of the FMU, as both versions of FMI see it: robots, mode, variables by reference, log. No FMI types. */
#ifndef LAGLAB_INSTANCE_H
#define LAGLAB_INSTANCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "robot.h"

/* The numbers are those of fmi2Status and fmi3Status. DISCARD: a value was refused, nothing has changed. */
typedef enum { STATUS_OK, STATUS_WARNING, STATUS_DISCARD, STATUS_ERROR } Status;

/* Not by the bare names: importers' build files define those as macros. */
typedef enum { KIND_MODEL_EXCHANGE, KIND_CO_SIMULATION } Kind;

typedef enum {
    MODE_INSTANTIATED = 1,
    MODE_CONFIGURATION = 2,
    MODE_INITIALIZATION = 4,
    MODE_EVENT = 8,
    MODE_CONTINUOUS_TIME = 16,
    MODE_STEP = 32,
    MODE_TERMINATED = 64,
    MODE_STEP_EVENT = 128, /* event mode of co-simulation */
    MODE_INTERMEDIATE = 256
} Mode;

enum {
    MODES_START = MODE_INSTANTIATED | MODE_INITIALIZATION,
    MODES_RUN = MODE_EVENT | MODE_CONTINUOUS_TIME | MODE_STEP | MODE_STEP_EVENT,
    MODES_ANY = MODES_START | MODES_RUN | MODE_CONFIGURATION | MODE_TERMINATED,
    MODES_READ = MODES_ANY | MODE_INTERMEDIATE
};

/* Room for one logged line. */
enum { MESSAGE_SIZE = 512 };

enum { LOG_EVENTS = 1, LOG_DISCARD = 2, LOG_ERROR = 4 };

typedef enum { TYPE_FLOAT64, TYPE_INT32, TYPE_INT64, TYPE_UINT64, TYPE_BOOLEAN } Type;

typedef enum { ROLE_TIME, ROLE_ROBOTS, ROLE_PARAMETER, ROLE_TUNABLE, ROLE_INPUT, ROLE_OUTPUT, ROLE_DERIVATIVE } Role;

/* A line of the table of variables; its value reference is its index. */
typedef struct {
    const char *name;
    Type type;
    Role role;
    size_t offset; /* in Robot */
    double minimum, maximum, start;
} Variable;

static inline bool is_settable(const Variable *variable) {
    return variable->role == ROLE_PARAMETER || variable->role == ROLE_TUNABLE || variable->role == ROLE_INPUT;
}

typedef struct Instance Instance;
typedef void (*LogFunction)(const Instance *, Status, const char *category, const char *message);
/* Lets the importer read in the middle of a step; true when it asks for the step to end there. */
typedef bool (*UpdateFunction)(const Instance *, double time);

typedef struct {
    bool event_needed, early_return;
} StepEnd;

struct Instance {
    uint64_t zero; /* an importer that takes the first word for a pointer to free finds none */
    Kind kind;
    Mode mode;
    const char *const *tokens; /* of the FMUs that the face serves; NULL ends them */
    LogFunction log;
    void (*callback)(void); /* the importer's logger, in the version's own type */
    void *environment;
    char *name;
    UpdateFunction update; /* called at every sample inside a step; NULL for never */
    void (*update_callback)(void);
    bool event_mode;   /* in co-simulation: samples are taken in event mode, not by the step itself ... */
    bool early_return; /* ... which ends at the first, or wherever `update` asks for it */
    unsigned logged;   /* LOG_ categories */
    bool stale;        /* what follows from inputs, parameters and states is not yet computed */
    size_t robots;
    Robot *robot, *before;              /* `before` has room for what a step may have to take back */
    double start_time, stop_time, time; /* without a stop, infinity */
};

/* NULL when the token is none of the draft's or memory runs out; says so through `log`. */
Instance *instance_new(const Instance *draft, const char *name, const char *token, bool debug);
void instance_free(Instance *instance);

/* Sends one line to the importer if its category is on, and hands `status` back. */
Status instance_log(const Instance *instance, Status status, const char *format, ...);
Status instance_set_logging(Instance *instance, bool on, size_t count, const char *const categories[]);

/* Whether the call is legal in the present mode; logs when not. */
bool instance_allows(const Instance *instance, int modes, const char *call);

Status instance_configure(Instance *instance, size_t robots);
/* Start and stop of the experiment, for `instance_enter_initialization`; without a stop, INFINITY. */
Status instance_set_experiment(Instance *instance, double start_time, double stop_time);
Status instance_enter_initialization(Instance *instance);
Status instance_reset(Instance *instance);
/* Whether a step may end there: not beyond the stop; logs when it is. In model exchange solvers may look beyond. */
Status instance_check_stop(const Instance *instance, double time, const char *what);
/* A refused step moves no robot. */
Status instance_step(Instance *instance, double start, double step, StepEnd *end);

/* Brings every value that follows from others up to date. */
void instance_refresh(Instance *instance);
/* Whether arithmetic has overflowed in no output; logs the name of one where it has. Refreshes. */
Status instance_check_finite(Instance *instance);
/* For one variable's value, of robot `robot`. */
Status instance_check_value(const Instance *instance, const char *name, size_t robot, double value);

/* The variable, or NULL and one logged line when the reference is not one of that type. */
const Variable *instance_variable(const Instance *instance, Type type, uint32_t reference, const char *call);
bool instance_has_type(uint32_t reference, Type type);
/* Whether `size` values is what the variables hold; logs when not. */
Status instance_check_size(const Instance *instance, Type type, const uint32_t references[], size_t count, size_t size,
                           const char *call);
size_t instance_size(const Instance *instance, const Variable *variable);

Status instance_get_floats(Instance *instance, const uint32_t references[], size_t count, double values[], size_t size,
                           const char *call);
Status instance_set_floats(Instance *instance, const uint32_t references[], size_t count, const double values[],
                           size_t size, const char *call);
/* Booleans, integers and enumerations. `robot` counts from 0. */
int64_t instance_integer(const Instance *instance, const Variable *variable, size_t robot);
Status instance_check_integer(const Instance *instance, const Variable *variable, double value, const char *call);
Status instance_set_integer(Instance *instance, const Variable *variable, size_t robot, int64_t value);

/* Saved states: `*state` is NULL or an earlier one to write over. Serialized ones carry a checksum. */
typedef struct SavedState SavedState;
Status instance_save(const Instance *instance, SavedState **state);
Status instance_restore(Instance *instance, const SavedState *state);
size_t state_size(const SavedState *state);
Status state_serialize(const Instance *instance, const SavedState *state, unsigned char bytes[], size_t size);
Status state_deserialize(const Instance *instance, const unsigned char bytes[], size_t size, SavedState **state);

/* Variables between which partial derivatives are asked for. */
typedef struct {
    const uint32_t *unknowns, *knowns;
    size_t unknown_count, known_count;
} Partials;

/* sensitivity of the unknowns = J seed; the adjoint: sensitivity of the knowns = J' seed. */
Status instance_directional(Instance *instance, const Partials *partials, const double seed[], double sensitivity[],
                            const char *call);
Status instance_adjoint(Instance *instance, const Partials *partials, const double seed[], double sensitivity[],
                        const char *call);

/* Model exchange: continuous states are all x, then all y, then all theta. */
void instance_get_states(const Instance *instance, double states[]);
Status instance_set_states(Instance *instance, const double states[]);
Status instance_get_derivatives(Instance *instance, double derivatives[]);
Status instance_set_time(Instance *instance, double time);
void instance_take_samples(Instance *instance);
double instance_next_sample(const Instance *instance);

enum { STATES = 3 };

#endif
