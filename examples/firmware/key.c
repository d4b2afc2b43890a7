#define _DEFAULT_SOURCE

#include "key.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

static const time_t START_OF_2015 = 1420070400;

static const char *key_in(FILE *file, uint8_t key[KEY_SIZE]) {
    struct stat about;
    if (fstat(fileno(file), &about) != 0 || (about.st_mode & (S_IRWXG | S_IRWXO))) {
        return "others may read the key: run chmod 600 on it, or make another";
    }
    for (int i = 0; i < KEY_SIZE; i++) {
        unsigned int byte;
        if (fscanf(file, "%2x", &byte) != 1) {
            return "it is no key: it must hold 64 hexadecimal digits";
        }
        key[i] = (uint8_t)byte;
    }
    return NULL;
}

const char *key_read(const char *path, uint8_t key[KEY_SIZE]) {
    FILE *file = fopen(path, "r");
    if (!file) {
        return strerror(errno);
    }
    const char *wrong = key_in(file, key);
    fclose(file);
    return wrong;
}

uint64_t key_time(void) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    return (uint64_t)(now.tv_sec - START_OF_2015) * 100000u + (uint64_t)now.tv_nsec / 10000u;
}
