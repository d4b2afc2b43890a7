/* Random numbers as a pure function of (seed, sample, stream): there is no generator state to save.
 *
 * Philox4x64-10: Salmon, Moraes, Dror, Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC 2011.
 * Inverse normal: Wichura, "Algorithm AS 241: PPND16", Applied Statistics 37 (1988).
 * Nothing here calls the C library, so that the bits are the same on every platform.
 */
#ifndef LAGLAB_NOISE_H
#define LAGLAB_NOISE_H

#include <stdint.h>

/* Four random words for the key (seed, 0) and the counter (sample, stream, 0, 0). */
void noise_words(uint64_t seed, uint64_t sample, uint64_t stream, uint64_t words[4]);

/* `count` <= 4 standard normal numbers, each from one word of `noise_words`. */
void noise_normal(uint64_t seed, uint64_t sample, uint64_t stream, int count, double normal[]);

/* Natural logarithm of a positive normal number, within 2 units in the last place. */
double noise_log(double x);

/* The x for which a standard normal variable is below x with probability 0 < p < 1. */
double noise_quantile(double p);

#endif
