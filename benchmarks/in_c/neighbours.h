/* Each ball against the next one. SI. */
#ifndef NEIGHBOURS_H
#define NEIGHBOURS_H

#include "sides.h"

static inline int64_t after(int64_t b, int64_t count) { return b + 1 < count ? b + 1 : 0; }

/* Write the equation of ball `b` and the next, whose centres are (ex, ey) (m) apart. */
static void link(int64_t b, double ex, double ey, double square, const Balls *q, Bearing *m)
{
    Side *c = &m->side;
    Chain *chain = &m->chain;
    const int64_t count = m->count, on = after(b, count), back = b > 0 ? b - 1 : count - 1;
    const double distance = sqrt(square), half = 0.5 * distance;
    const Place at = {ex / distance, ey / distance, 2.0 * m->ball_radius - distance, -half, half};
    double beside = c->normal[back] * (c->nx[back] * at.nx + c->ny[back] * at.ny);
    beside += c->normal[on] * (c->nx[on] * at.nx + c->ny[on] * at.ny);
    const double across = 2.0 / m->mass + 2.0 * half * half / m->inertia, along = 2.0 * (1.0 / m->mass);
    const Kick kick = kick_of(m->kick, across, along, ball_of(&m->before.balls, on),
                              ball_of(&m->before.balls, b), at, OUTSIDE, c->tangential[b],
                              c->normal[b] - 0.5 * beside);
    double elastic, damping;
    slip(ball_of(q, on), ball_of(q, b), at, OUTSIDE, &c->sliding[b], &c->rate[b]);
    elastic_and_damping(at.indentation, &m->side_contact, &elastic, &damping);
    c->stiffness[b] = 1.5 * elastic / at.indentation;
    elastic = passive(elastic, at.indentation / 2.5, c->stored[b], c->rate[b], kick.rate, kick.along, m->kick,
                      m->drift);
    const double z = kick.along * damping;
    chain->elastic[b] = elastic, chain->driven[b] = kick.sliding, chain->across[b] = kick.across;
    chain->pull[b] = 0.5 * (3.0 + z) * z;
    chain->base[b] = 6.0 + z * (4.0 + z);
    chain->free[b] = (6.0 + z) * (elastic + damping * c->rate[b]) + (3.0 + z) * damping * kick.rate;
    c->nx[b] = at.nx, c->ny[b] = at.ny, c->first[b] = at.first, c->second[b] = at.second;
    c->indentation[b] = at.indentation;
}

static inline double alike(const Side *c, int64_t b, int64_t k)
{
    return c->nx[b] * c->nx[k] + c->ny[b] * c->ny[k];
}

/* Normal forces (N) of all neighbours that touch, solved together from a gap on; without one, from ball 0,
   where the forces of the kick before count. */
static void share(Side *c, Chain *chain, int64_t count)
{
    int64_t gap = 0;
    while (gap < count && c->indentation[gap] > 0.0) gap++;
    const int closed = gap == count;
    double held = closed ? c->normal[count - 1] : 0.0, gain = 0.0, beyond = closed ? c->normal[0] : 0.0;
    int64_t b = closed ? count - 1 : gap;
    for (int64_t i = 0; i < count; i++) {
        const int64_t back = b;
        b = after(b, count);
        if (c->indentation[b] > 0.0) {
            const double pull = chain->pull[b] * alike(c, back, b);
            const double inverse = 1.0 / (chain->base[b] - pull * gain);
            held = (chain->free[b] + pull * held) * inverse;
            gain = chain->pull[b] * alike(c, b, after(b, count)) * inverse;
        } else {
            held = gain = 0.0;
        }
        chain->free[b] = held, chain->pull[b] = gain;
    }
    for (int64_t i = 0; i < count; i++) {
        beyond = larger(chain->free[b] + chain->pull[b] * beyond, 0.0);
        if (c->indentation[b] > 0.0) c->normal[b] = beyond;
        else note_apart(c, b);
        b = b > 0 ? b - 1 : count - 1;
    }
}

/* Ball `b` and the next push and rub each other. */
static void press_neighbours(int64_t b, Bearing *m)
{
    const Side *c = &m->side;
    const Chain *chain = &m->chain;
    const Place at = {c->nx[b], c->ny[b], c->indentation[b], c->first[b], c->second[b]};
    const Squeeze s = {c->sliding[b], c->rate[b], c->normal[b], c->normal[b] - chain->elastic[b]};
    const Press press = rub_side(b, at, OUTSIDE, s, chain->across[b], chain->driven[b], m);
    push(after(b, m->count), press.fx, press.fy, press.first_moment, m);
    push(b, -press.fx, -press.fy, press.second_moment, m);
}

/* Each ball against the next. Returns whether any touch. */
static int press_all_neighbours(const State *restrict q, Bearing *restrict m)
{
    const int64_t count = m->count;
    const double *x = q->balls.x, *y = q->balls.y, apart = 2.0 * m->ball_radius;
    int touching = 0;
    for (int64_t b = 0; b < count; b++) {
        const int64_t k = after(b, count);
        const double ex = x[k] - x[b], ey = y[k] - y[b], square = ex * ex + ey * ey;
        if (square >= apart * apart) {
            m->side.indentation[b] = -1.0;
            continue;
        }
        link(b, ex, ey, square, &q->balls, m);
        touching = 1;
    }
    if (!touching) {
        for (int64_t b = 0; b < count; b++) note_apart(&m->side, b);
        return 0;
    }
    share(&m->side, &m->chain, count);
    for (int64_t b = 0; b < count; b++)
        if (m->side.indentation[b] > 0.0) press_neighbours(b, m);
    return 1;
}

/* Heat (W) between neighbours over the kick whose accelerations are in dq. */
static double heat_between(const State *dq, Bearing *m)
{
    double loss = 0.0;
    for (int64_t b = 0; b < m->count; b++) {
        if (m->side.indentation[b] <= 0.0) continue;
        loss += heat_at(b, ball_of(&dq->balls, after(b, m->count)), ball_of(&dq->balls, b), OUTSIDE, m);
    }
    return loss;
}

#endif
