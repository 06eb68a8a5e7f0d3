/* A rubber ring: the journal is carried as a point mass through the macro step, in short steps; what goes
   out is the mean of its load, and the slope. SI; x horizontal, y up; a load is named after its body. */
#include "memory.h" /* Memory, made of the declarations in rubber_ring.py */

#include <math.h>

enum { STEPS = 20 }; /* in a macro step */

/* What bounds of single parameters leave open: the number of what is wrong (from 1), or 0. */
int64_t model_derive(Memory *m)
{
    m->message_numbers[0] = m->p.clearance;
    return m->p.clearance < 10e-3 ? 0 : 1;
}

/* First outputs; all of them are 0 already. */
void model_start(Memory *m)
{
    (void)m;
}

/* Radial force on the journal (N, positive outwards) at (x, y) from the housing's middle, in m and m/s. */
static double push(const Memory *m, double x, double y, double vx, double vy)
{
    double r = hypot(x, y), depth = r - m->p.clearance;
    if (depth <= 0.0) return 0.0;
    return -fmax(0.0, m->p.stiffness * depth + m->p.damping * (vx * x + vy * y) / r);
}

/* One macro step of `step` (s) from `time` (s); returns one of the statuses in memory.h. */
int64_t model_advance(Memory *m, double time, double step)
{
    const double h = step / STEPS;
    double x = m->u.journal.x, y = m->u.journal.y, vx = m->u.journal.vx, vy = m->u.journal.vy;
    double impulse[2] = {0.0, 0.0}, moment[2] = {0.0, 0.0}; /* N s, N s2 about the middle */
    (void)time;
    if (!isfinite(x + y + vx + vy + m->u.housing.x + m->u.housing.y)) return BAD_INPUT;
    for (int k = 0; k < STEPS; k++) {
        const double t = (k + 0.5) * h - 0.5 * step, middle = m->u.housing.x, height = m->u.housing.y;
        const double dx = x - middle, dy = y - height, r = hypot(dx, dy);
        const double force = push(m, dx, dy, vx - m->u.housing.vx, vy - m->u.housing.vy);
        const double load[2] = {r > 0.0 ? force * dx / r : 0.0, r > 0.0 ? force * dy / r : 0.0};
        for (int i = 0; i < 2; i++) {
            impulse[i] += h * load[i];
            moment[i] += h * load[i] * t;
        }
        vx += h * (m->u.journal.ax_free + m->u.journal.inv_m * load[0]);
        vy += h * (m->u.journal.ay_free + m->u.journal.inv_m * load[1]);
        x += h * vx;
        y += h * vy;
        m->o.peak_force = fmax(m->o.peak_force, fabs(force));
    }
    m->o.journal.fx = impulse[0] / step;
    m->o.journal.fy = impulse[1] / step;
    m->o.journal.dfx = 12.0 * moment[0] / (step * step * step);
    m->o.journal.dfy = 12.0 * moment[1] / (step * step * step);
    m->o.housing.fx = -m->o.journal.fx;
    m->o.housing.fy = -m->o.journal.fy;
    m->o.housing.dfx = -m->o.journal.dfx;
    m->o.housing.dfy = -m->o.journal.dfy;
    return isfinite(x + y + vx + vy) ? OK : BAD_LOAD;
}
