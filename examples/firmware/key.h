/* The key that station and robot share, and the clock that signatures go by: on a real robot, from its flash and its
 * clock. */
#ifndef KEY_H
#define KEY_H

#include <stdint.h>

#define KEY_SIZE 32

/* Read the file that `laglab protocol keygen` makes; NULL, or what is wrong with it. */
const char *key_read(const char *path, uint8_t key[KEY_SIZE]);

/* Now, in 10 us since the start of 2015. */
uint64_t key_time(void);

#endif
