#include "noise.h"

#include <string.h>

/* The square root is correctly rounded wherever IEEE 754 holds, so its bits are the same everywhere. */
#include <math.h>

enum { ROUNDS = 10 };

static const uint64_t MULTIPLIER[2] = {0xD2E7470EE14C6C93, 0xCA5A826395121157};
static const uint64_t WEYL[2] = {0x9E3779B97F4A7C15, 0xBB67AE8584CAA73B};

/* High 64 bits of a 64 x 64 bit product. */
#ifdef __SIZEOF_INT128__
static uint64_t multiply_high(uint64_t a, uint64_t b) {
    return (uint64_t)((__extension__(unsigned __int128) a * b) >> 64);
}
#else
/* Out of 32 x 32 bit products: C99 has no wider type. */
static uint64_t multiply_high(uint64_t a, uint64_t b) {
    const uint64_t mask = 0xFFFFFFFF;
    const uint64_t low = (a & mask) * (b & mask);
    const uint64_t cross = (a >> 32) * (b & mask) + (low >> 32);
    const uint64_t other = (a & mask) * (b >> 32) + (cross & mask);
    return (a >> 32) * (b >> 32) + (cross >> 32) + (other >> 32);
}
#endif

void noise_words(uint64_t seed, uint64_t sample, uint64_t stream, uint64_t words[4]) {
    uint64_t a = sample, b = stream, c = 0, d = 0;
    uint64_t key[2] = {seed, 0};
    for (int round = 0; round < ROUNDS; round++) {
        const uint64_t high_a = multiply_high(MULTIPLIER[0], a), low_a = MULTIPLIER[0] * a;
        const uint64_t high_c = multiply_high(MULTIPLIER[1], c), low_c = MULTIPLIER[1] * c;
        a = high_c ^ b ^ key[0];
        b = low_c;
        c = high_a ^ d ^ key[1];
        d = low_a;
        key[0] += WEYL[0];
        key[1] += WEYL[1];
    }
    words[0] = a;
    words[1] = b;
    words[2] = c;
    words[3] = d;
}

/* x = m 2^e with m in [sqrt(1/2), sqrt(2)); log m = 2 artanh s = 2 (s + s^3/3 + s^5/5 + ...), s = (m-1)/(m+1). */
double noise_log(double x) {
    static const double LN2 = 0.693147180559945309417;
    static const double SQRT2 = 1.41421356237309504880;
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    int exponent = (int)(bits >> 52) - 1023;
    bits = (bits & 0x000FFFFFFFFFFFFF) | 0x3FF0000000000000;
    double m;
    memcpy(&m, &bits, sizeof m);
    if (m >= SQRT2) {
        m *= 0.5;
        exponent++;
    }
    const double s = (m - 1.0) / (m + 1.0), square = s * s;
    double sum = 0.0;
    for (int odd = 23; odd >= 3; odd -= 2) {
        sum = square * (1.0 / odd + sum);
    }
    return exponent * LN2 + 2.0 * (s + s * sum);
}

/* a[0] + a[1] r + ... + a[7] r^7 over the same in b. */
static double ratio(const double a[8], const double b[8], double r) {
    double above = a[7], below = b[7];
    for (int i = 6; i >= 0; i--) {
        above = above * r + a[i];
        below = below * r + b[i];
    }
    return above / below;
}

double noise_quantile(double p) {
    static const double A[8] = {3.3871328727963666080e0,  1.3314166789178437745e+2, 1.9715909503065514427e+3,
                                1.3731693765509461125e+4, 4.5921953931549871457e+4, 6.7265770927008700853e+4,
                                3.3430575583588128105e+4, 2.5090809287301226727e+3};
    static const double B[8] = {1.00000000000000000000,   4.2313330701600911252e+1, 6.8718700749205790830e+2,
                                5.3941960214247511077e+3, 2.1213794301586595867e+4, 3.9307895800092710610e+4,
                                2.8729085735721942674e+4, 5.2264952788528545610e+3};
    static const double C[8] = {1.42343711074968357734e0,  4.63033784615654529590e0, 5.76949722146069140550e0,
                                3.64784832476320460504e0,  1.27045825245236838258e0, 2.41780725177450611770e-1,
                                2.27238449892691845833e-2, 7.74545014278341407640e-4};
    static const double D[8] = {1.00000000000000000000,    2.05319162663775882187e0,  1.67638483018380384940e0,
                                6.89767334985100004550e-1, 1.48103976427480074590e-1, 1.51986665636164571966e-2,
                                5.47593808499534494600e-4, 1.05075007164441684324e-9};
    static const double E[8] = {6.65790464350110377720e0,  5.46378491116411436990e0,  1.78482653991729133580e0,
                                2.96560571828504891230e-1, 2.65321895265761230930e-2, 1.24266094738807843860e-3,
                                2.71155556874348757815e-5, 2.01033439929228813265e-7};
    static const double F[8] = {1.00000000000000000000,    5.99832206555887937690e-1, 1.36929880922735805310e-1,
                                1.48753612908506148525e-2, 7.86869131145613259100e-4, 1.84631831751005468180e-5,
                                1.42151175831644588870e-7, 2.04426310338993978564e-15};
    const double q = p - 0.5;
    if (q >= -0.425 && q <= 0.425) {
        return q * ratio(A, B, 0.180625 - q * q);
    }
    const double r = sqrt(-noise_log(q < 0 ? p : 1.0 - p));
    const double tail = r <= 5.0 ? ratio(C, D, r - 1.6) : ratio(E, F, r - 5.0);
    return q < 0 ? -tail : tail;
}

void noise_normal(uint64_t seed, uint64_t sample, uint64_t stream, int count, double normal[]) {
    uint64_t words[4];
    noise_words(seed, sample, stream, words);
    for (int i = 0; i < count; i++) {
        /* An odd multiple of 2^-53: all 53 bits used, never 0 or 1, and symmetric about 1/2. */
        normal[i] = noise_quantile((double)((words[i] >> 11) | 1) * 0x1p-53);
    }
}
