/* Saved states. The noise needs none of its own: it follows from seed and sample, which are in the Robot.
 *
 * Serialized: little-endian words of eight bytes: the checksum of all that follows and of a token, the head, then the
 * robots' fields in order. The token is one and the same for all FMUs of a model: they understand each other's states.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "instance.h"
#include "variables.h"

typedef struct {
    uint64_t robots, kind, mode;
    double start_time, stop_time, time;
} Head;

struct SavedState {
    uint64_t zero; /* an importer that takes the first word for a pointer to free finds none */
    Head head;
    Robot robot[];
};

enum {
    WORD = 8,
    HEAD_WORDS = sizeof(Head) / WORD,
    ROBOT_WORDS = sizeof(Robot) / WORD,
    FRONT = (1 + HEAD_WORDS) * WORD /* bytes before the robots */
};

/* Samples are counted in doubles too, by the time that they take. */
static const int64_t LAST_SAMPLE = (int64_t)1 << 53;

static size_t memory_size(size_t robots) {
    return sizeof(SavedState) + robots * sizeof(Robot);
}

Status instance_save(const Instance *instance, SavedState **state) {
    SavedState *saved = realloc(*state, memory_size(instance->robots));
    if (!saved) {
        return instance_log(instance, STATUS_ERROR, "no memory to save the state of %zu robots", instance->robots);
    }
    saved->zero = 0;
    saved->head = (Head){instance->robots,     instance->kind,      instance->mode,
                         instance->start_time, instance->stop_time, instance->time};
    memcpy(saved->robot, instance->robot, instance->robots * sizeof(Robot));
    *state = saved;
    return STATUS_OK;
}

Status instance_restore(Instance *instance, const SavedState *state) {
    const Head *head = &state->head;
    if (head->kind != (uint64_t)instance->kind || head->robots != instance->robots) {
        return instance_log(instance, STATUS_ERROR,
                            "the saved state is of %zu robot(s) in %s, the instance of %zu in %s", (size_t)head->robots,
                            head->kind == KIND_CO_SIMULATION ? "co-simulation" : "model exchange", instance->robots,
                            instance->kind == KIND_CO_SIMULATION ? "co-simulation" : "model exchange");
    }
    if (head->mode == MODE_STEP_EVENT && !instance->event_mode) {
        return instance_log(instance, STATUS_ERROR,
                            "the saved state is in event mode, which the instance does not use");
    }
    instance->mode = (Mode)head->mode;
    instance->start_time = head->start_time;
    instance->stop_time = head->stop_time;
    instance->time = head->time;
    memcpy(instance->robot, state->robot, instance->robots * sizeof(Robot));
    instance->stale = true;
    return STATUS_OK;
}

static size_t serialized_size(size_t robots) {
    return FRONT + robots * sizeof(Robot);
}

size_t state_size(const SavedState *state) {
    return serialized_size(state->head.robots);
}

static void write_words(const void *words, size_t count, unsigned char *bytes) {
    for (size_t i = 0; i < count; i++) {
        uint64_t word;
        memcpy(&word, (const char *)words + i * WORD, WORD);
        for (int k = 0; k < WORD; k++) {
            bytes[i * WORD + (size_t)k] = (unsigned char)(word >> (8 * k));
        }
    }
}

static void read_words(const unsigned char *bytes, size_t count, void *words) {
    for (size_t i = 0; i < count; i++) {
        uint64_t word = 0;
        for (int k = 0; k < WORD; k++) {
            word |= (uint64_t)bytes[i * WORD + (size_t)k] << (8 * k);
        }
        memcpy((char *)words + i * WORD, &word, WORD);
    }
}

/* FNV-1a */
static uint64_t add_to_checksum(uint64_t sum, const void *bytes, size_t size) {
    for (size_t i = 0; i < size; i++) {
        sum = (sum ^ ((const unsigned char *)bytes)[i]) * 0x100000001B3;
    }
    return sum;
}

static uint64_t checksum(const unsigned char *bytes, size_t size) {
    const uint64_t token = add_to_checksum(0xCBF29CE484222325, TOKEN_3, sizeof TOKEN_3);
    return add_to_checksum(token, bytes + WORD, size - WORD);
}

Status state_serialize(const Instance *instance, const SavedState *state, unsigned char bytes[], size_t size) {
    if (size < state_size(state)) {
        return instance_log(instance, STATUS_ERROR, "a serialized state needs %zu bytes, not %zu", state_size(state),
                            size);
    }
    write_words(&state->head, HEAD_WORDS, bytes + WORD);
    write_words(state->robot, state->head.robots * ROBOT_WORDS, bytes + FRONT);
    const uint64_t sum = checksum(bytes, state_size(state));
    write_words(&sum, 1, bytes);
    return STATUS_OK;
}

static bool head_is_sound(const Head *head) {
    const int modes =
        head->kind == KIND_CO_SIMULATION ? MODE_STEP | MODE_STEP_EVENT : MODE_EVENT | MODE_CONTINUOUS_TIME;
    const int any = modes | MODES_START | MODE_CONFIGURATION | MODE_TERMINATED;
    const bool one_mode = head->mode != 0 && (head->mode & (head->mode - 1)) == 0;
    return (head->kind == KIND_CO_SIMULATION || head->kind == KIND_MODEL_EXCHANGE) && one_mode &&
           (head->mode & ~(uint64_t)any) == 0 && isfinite(head->start_time) && isfinite(head->time) &&
           head->start_time <= head->stop_time;
}

/* The name of a field whose value no run could have reached; NULL when there is none. */
static const char *unsound_field(const Robot *robot) {
    for (size_t i = 0; i < VARIABLES; i++) {
        const Variable *variable = &VARIABLE[i];
        if (!is_settable(variable)) {
            continue;
        }
        double value;
        int64_t whole;
        memcpy(&value, (const char *)robot + variable->offset, sizeof value);
        memcpy(&whole, (const char *)robot + variable->offset, sizeof whole);
        value = variable->type == TYPE_FLOAT64 ? value : (double)whole;
        if (!isfinite(value) || value < variable->minimum || value > variable->maximum) {
            return variable->name;
        }
    }
    if (!(robot->elapsed >= 0.0 && robot->elapsed <= robot->sample_time)) {
        return "elapsed";
    }
    return robot->sample < 0 || robot->sample > LAST_SAMPLE ? "sample" : NULL;
}

static Status check(const Instance *instance, const unsigned char bytes[], size_t size, Head *head) {
    uint64_t sum = 0;
    if (size >= FRONT) {
        read_words(bytes, 1, &sum);
        read_words(bytes + WORD, HEAD_WORDS, head);
    }
    const size_t most = (SIZE_MAX - FRONT) / sizeof(Robot);
    if (size < FRONT || head->robots == 0 || head->robots > most || size != serialized_size(head->robots)) {
        return instance_log(instance, STATUS_ERROR, "serialized state: %zu bytes is not its size", size);
    }
    if (sum != checksum(bytes, size)) {
        return instance_log(instance, STATUS_ERROR, "serialized state: the checksum does not fit its bytes");
    }
    if (!head_is_sound(head)) {
        return instance_log(instance, STATUS_ERROR, "serialized state: its kind, mode or time is impossible");
    }
    return STATUS_OK;
}

Status state_deserialize(const Instance *instance, const unsigned char bytes[], size_t size, SavedState **state) {
    Head head = {0};
    if (check(instance, bytes, size, &head) != STATUS_OK) {
        return STATUS_ERROR;
    }
    SavedState *read = malloc(memory_size(head.robots));
    if (!read) {
        return instance_log(instance, STATUS_ERROR, "no memory for the state of %zu robots", (size_t)head.robots);
    }
    read->zero = 0;
    read->head = head;
    read_words(bytes + FRONT, head.robots * ROBOT_WORDS, read->robot);
    for (size_t i = 0; i < head.robots; i++) {
        const char *field = unsound_field(&read->robot[i]);
        if (field) {
            free(read);
            return instance_log(instance, STATUS_ERROR, "serialized state: %s of robot %zu is impossible", field, i);
        }
    }
    free(*state);
    *state = read;
    return STATUS_OK;
}
