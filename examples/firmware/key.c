#define _DEFAULT_SOURCE

#include "key.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

static const time_t START_OF_2015 = 1420070400;

/* The next byte, of two digits side by side, or -1. scanf's %x would take 0x, a sign and a digit alone for one. */
static int byte_in(FILE *file) {
    char digits[3] = {0};
    if (fscanf(file, " %2c", digits) != 1 || !isxdigit((unsigned char)digits[0]) ||
        !isxdigit((unsigned char)digits[1])) {
        return -1;
    }
    return (int)strtol(digits, NULL, 16);
}

static const char *key_in(FILE *file, uint8_t key[KEY_SIZE]) {
    static const char *const no_key = "it is no key: it must hold 64 hexadecimal digits";
    struct stat about;
    if (fstat(fileno(file), &about) != 0 || (about.st_mode & (S_IRWXG | S_IRWXO))) {
        return "others may read the key: run chmod 600 on it, or make another";
    }
    for (int i = 0; i < KEY_SIZE; i++) {
        const int byte = byte_in(file);
        if (byte < 0) {
            return no_key;
        }
        key[i] = (uint8_t)byte;
    }
    char more;
    return fscanf(file, " %c", &more) == 1 ? no_key : NULL;
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
