/* Each ball against its pocket in the cage, a circle that turns with it. SI. */
#ifndef POCKETS_H
#define POCKETS_H

#include "sides.h"

/* Cosine and sine of the cage's angle, by which its pockets are turned. */
typedef struct { double cosine, sine; } Turned;

/* Motion of a pocket at (rx, ry) (m) from the middle of a cage. */
static inline Motion pocket_of(const Cage *cage, double rx, double ry)
{
    const double spin = cage->spin;
    const Motion pocket = {cage->x + rx, cage->y + ry, cage->vx - spin * ry, cage->vy + spin * rx, spin};
    return pocket;
}

static inline void pocket_at(int64_t b, Turned by, const Bearing *m, double *rx, double *ry)
{
    *rx = by.cosine * m->pocket_x[b] - by.sine * m->pocket_y[b];
    *ry = by.sine * m->pocket_x[b] + by.cosine * m->pocket_y[b];
}

/* What ball `b` and its pocket, at (rx, ry) (m), answer over a kick. */
static inline Kick kick_in_pocket(int64_t b, Place at, double rx, double ry, const Bearing *m)
{
    const double lever = at.second + rx * at.nx + ry * at.ny, off = rx * at.ny - ry * at.nx;
    const double both = 1.0 / m->mass + 1.0 / m->cage_mass;
    const double turning = m->ball_radius * m->ball_radius / m->inertia;
    const double across = both + turning + lever * lever / m->cage_inertia;
    return kick_of(m->kick, across, both + off * off / m->cage_inertia, ball_of(&m->before.balls, b),
                   pocket_of(&m->before.cage, rx, ry), at, INSIDE, m->side.tangential[b],
                   m->side.normal[b]);
}

/* All balls squeezed against their pockets; those that do not touch get an indentation of -1. */
static void squeeze_pockets(const State *restrict q, Turned by, Bearing *restrict m)
{
    Side *c = &m->side;
    const Law law = m->side_contact;
    const double clearance = m->cage_clearance, rb = m->ball_radius;
    for (int64_t b = 0, n = in_full(m->count); b < n; b++) {
        double rx, ry, sliding, rate;
        pocket_at(b, by, m, &rx, &ry);
        const Motion ball = ball_of(&q->balls, b), pocket = pocket_of(&q->cage, rx, ry);
        const double ex = ball.x - pocket.x, ey = ball.y - pocket.y, square = ex * ex + ey * ey;
        const int apart = square <= clearance * clearance;
        const double distance = apart ? 1.0 : sqrt(square), indentation = distance - clearance;
        const Place at = {ex / distance, ey / distance, indentation, rb, distance + rb};
        const Kick kick = kick_in_pocket(b, at, rx, ry, m);
        slip(ball, pocket, at, INSIDE, &sliding, &rate);
        const double depth = larger(indentation, 0.0), asked = law.stiffness * (depth * sqrt(depth));
        const double elastic = passive(asked, indentation / 2.5, c->stored[b], rate, kick.rate, kick.along,
                                       m->kick, m->drift);
        const double some = law.dissipation * asked + law.damping * indentation + law.viscous;
        const double damping = indentation > 0.0 ? some : 0.0;
        const double normal = damped_normal(elastic, damping, rate, kick.along, kick.rate);
        c->nx[b] = at.nx, c->ny[b] = at.ny, c->first[b] = rb, c->second[b] = at.second;
        c->sliding[b] = sliding, c->rate[b] = rate, c->normal[b] = apart ? 0.0 : normal;
        c->damped[b] = apart ? 0.0 : normal - elastic, c->indentation[b] = apart ? -1.0 : indentation;
        c->stiffness[b] = 1.5 * asked / indentation;
        m->chain.across[b] = kick.across, m->chain.driven[b] = kick.sliding;
    }
}

/* Their friction, and what comes of both for the balls. */
static void rub_pockets(Bearing *restrict m)
{
    Side *c = &m->side;
    const Chain *chain = &m->chain;
    const Friction law = m->side_friction;
    const double viscous = m->side_contact.viscous;
    for (int64_t b = 0, n = in_full(m->count); b < n; b++) {
        const double normal = c->normal[b], sliding = c->sliding[b], across = chain->across[b];
        const double driven = chain->driven[b], indentation = c->indentation[b], rate = c->rate[b];
        const int apart = indentation < 0.0;
        const Line line = line_of(sliding, sliding + driven, across, normal, &law);
        const double rubbing = (line.start - line.slope * driven) / (line.base + line.slope * across);
        const double friction = apart ? 0.0 : rubbing;
        c->tangential[b] = friction, c->highest[b] = apart ? 0.0 : larger(normal, viscous * rate);
        c->stiffness[b] = apart ? 0.0 : 1.5 * (normal - c->damped[b]) / indentation;
        m->faster.x[b] += (-normal * c->nx[b] - friction * c->ny[b]) / m->mass;
        m->faster.y[b] += (-normal * c->ny[b] + friction * c->nx[b]) / m->mass;
        m->faster.spin[b] += c->first[b] * friction / m->inertia;
    }
}

/* All balls against their pockets; sets the cage's part of dq. */
static Turned press_pockets(const State *restrict q, State *restrict dq, Bearing *restrict m)
{
    const Turned by = {cos(q->cage.angle), sin(q->cage.angle)};
    const Side *c = &m->side;
    double fx = 0.0, fy = 0.0, moment = 0.0;
    squeeze_pockets(q, by, m);
    rub_pockets(m);
    for (int64_t b = 0; b < m->count; b++) {
        double rx, ry;
        pocket_at(b, by, m, &rx, &ry);
        const double normal = c->normal[b], friction = c->tangential[b];
        const double px = -normal * c->nx[b] - friction * c->ny[b];
        const double py = -normal * c->ny[b] + friction * c->nx[b];
        fx -= px;
        fy -= py;
        moment += -(c->second[b] * friction) - rx * py + ry * px;
    }
    dq->cage = (Cage){q->cage.vx, q->cage.vy, fx / m->cage_mass, fy / m->cage_mass - m->gravity,
                      q->cage.spin, moment / m->cage_inertia, {0.0, 0.0}};
    return by;
}

/* Heat (W) of all pockets over the kick whose accelerations are in dq. */
static double heat_in_pockets(const State *dq, Turned by, Bearing *m)
{
    double heat[MOST], loss = 0.0;
    for (int64_t b = 0, n = in_full(m->count); b < n; b++) {
        double rx, ry;
        pocket_at(b, by, m, &rx, &ry);
        heat[b] = heat_at(b, ball_of(&dq->balls, b), pocket_of(&dq->cage, rx, ry), INSIDE, m);
    }
    for (int64_t b = 0; b < m->count; b++) loss += heat[b]; /* of those apart 0: no force */
    return loss;
}

#endif
