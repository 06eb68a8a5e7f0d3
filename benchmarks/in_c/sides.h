/* What touches a ball beside: the next one, or its pocket in the cage. SI. */
#ifndef SIDES_H
#define SIDES_H

#include "contact.h"

static inline Motion ball_of(const Balls *balls, int64_t b)
{
    const Motion ball = {balls->x[b], balls->y[b], balls->vx[b], balls->vy[b], balls->spin[b]};
    return ball;
}

static inline void note_apart(Side *c, int64_t b)
{
    c->normal[b] = c->highest[b] = c->tangential[b] = c->stiffness[b] = 0.0;
    c->indentation[b] = -1.0;
}

static inline void push(int64_t b, double fx, double fy, double moment, Bearing *m)
{
    m->faster.x[b] += fx / m->mass;
    m->faster.y[b] += fy / m->mass;
    m->faster.spin[b] += moment / m->inertia;
}

/* Friction of ball `b`'s contact, which is squeezed; remembers the contact. */
static inline Press rub_side(int64_t b, Place at, double side, Squeeze s, double across, double driven,
                             Bearing *m)
{
    Side *c = &m->side;
    const Line line = line_of(s.sliding, s.sliding + driven, across, s.normal, &m->side_friction);
    const double friction = (line.start - line.slope * driven) / (line.base + line.slope * across);
    c->highest[b] = larger(s.normal, m->side_contact.viscous * s.rate);
    c->normal[b] = s.normal, c->tangential[b] = friction, c->damped[b] = s.damped;
    c->sliding[b] = s.sliding, c->rate[b] = s.rate, c->indentation[b] = at.indentation;
    c->nx[b] = at.nx, c->ny[b] = at.ny, c->first[b] = at.first, c->second[b] = at.second;
    return rubbed(at, side, s, friction);
}

/* Heat (W) of ball `b`'s contact over the kick that accelerates both bodies so. */
static inline double heat_at(int64_t b, Motion first, Motion second, double side, Bearing *m)
{
    Side *c = &m->side;
    const Place at = {c->nx[b], c->ny[b], c->indentation[b], c->first[b], c->second[b]};
    double sliding, rate;
    slip(first, second, at, side, &sliding, &rate);
    c->middle[b] = c->rate[b] + 0.5 * m->kick * rate;
    return c->damped[b] * c->middle[b] - c->tangential[b] * (c->sliding[b] + 0.5 * m->kick * sliding);
}

#endif
