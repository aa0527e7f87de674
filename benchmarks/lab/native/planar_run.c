/* A cart with N pendulums by hand: tensions of the rods, from the last to the first and back.
 *
 * A rod i along e_i passes on only what acts along it: force = (alpha_i e_i . a + beta_i) e_i.
 * values.h has N, MASS[N + 1], LENGTH[N + 1] (the first is not used) and GRAVITY.
 */
#include <math.h>
#include "values.h"

void run(const double *state, const double *inputs, double *result)
{
    const double *rate = state + N + 1;
    double c[N + 2], s[N + 2], swing[N + 1], stiff[N + 1], rest[N + 1], reciprocal[N + 1];
    double alpha = 0, beta = 0;
    c[N + 1] = s[N + 1] = 0;
    for (int i = N; i > 0; i--) {
        c[i] = cos(state[i]);
        s[i] = sin(state[i]);
        /* sine and cosine of the angle between this rod and the next */
        const double sine = c[i] * s[i + 1] - s[i] * c[i + 1];
        const double cosine = s[i] * s[i + 1] + c[i] * c[i + 1];
        swing[i] = LENGTH[i] * rate[i] * rate[i];
        stiff[i] = alpha * sine;
        const double gamma = beta - swing[i] * alpha * cosine;
        rest[i] = sine * gamma;
        reciprocal[i] = 1 / (MASS[i] + stiff[i] * sine);
        alpha = MASS[i] * reciprocal[i] * (MASS[i] + alpha);
        beta = MASS[i] * (cosine * gamma * reciprocal[i] - swing[i]);
    }
    double x = (inputs[0] - s[1] * (beta - alpha * c[1] * GRAVITY)) / (MASS[0] + alpha * s[1] * s[1]);
    double y = GRAVITY;
    result[0] = x;
    for (int i = 1; i <= N; i++) {
        const double across = c[i] * x + s[i] * y, next = s[i + 1] * x - c[i + 1] * y;
        const double step = -(MASS[i] * across + stiff[i] * next + rest[i]) * reciprocal[i];
        result[i] = step * (1 / LENGTH[i]);
        x += step * c[i] - swing[i] * s[i];
        y += step * s[i] + swing[i] * c[i];
    }
}
