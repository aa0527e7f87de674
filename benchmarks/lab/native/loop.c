/* Nanoseconds a call, over all states in turn: what every competitor is timed with. */
#include <time.h>

typedef void (*forward_dynamics)(const double *state, const double *inputs, double *result);

double nanoseconds(forward_dynamics run, const double *states, int nx, const double *inputs,
                   int nu, double *results, int n, int count, int rounds)
{
    struct timespec start, stop;
    clock_gettime(CLOCK_MONOTONIC, &start);
    for (int round = 0; round < rounds; round++) {
        for (int k = 0; k < count; k++) {
            run(states + k * nx, inputs + k * nu, results + k * n);
        }
    }
    clock_gettime(CLOCK_MONOTONIC, &stop);
    return ((stop.tv_sec - start.tv_sec) * 1e9 + (stop.tv_nsec - start.tv_nsec))
           / ((double)rounds * count);
}
