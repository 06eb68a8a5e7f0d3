/* Friction of all balls at both races and of the journal in the bore, solved together. SI. */
#ifndef RUBBING_H
#define RUBBING_H

#include "contact.h"

typedef struct { double fx, fy, moment, loss; } Total; /* what balls do to a race */
typedef struct { double x, y, spin; } Moved; /* what a kick does to the ring: m/s, rad/s */
typedef struct { double outer, inner, spin; } Answers; /* of a ball to friction in the kick: s/kg */

static inline double over_ring(double nx, double ny, double lever, Moved moved)
{
    return moved.y * nx - moved.x * ny + lever * moved.spin;
}

/* How all but friction at races changes the sliding speeds over the kick, and where it is to end so. */
static void drive(Answers a, Moved moved, Bearing *restrict m)
{
    Race *inner = &m->inner, *outer = &m->outer;
    const Rates *faster = &m->faster;
    const double h = m->kick, rb = m->ball_radius;
    for (int64_t b = 0, n = in_full(m->count); b < n; b++) {
        const double along_o = faster->y[b] * outer->nx[b] - faster->x[b] * outer->ny[b];
        const double along_i = faster->y[b] * inner->nx[b] - faster->x[b] * inner->ny[b];
        const double driven_o = h * (along_o + rb * faster->spin[b]);
        const double driven_i = h * (along_i - rb * faster->spin[b]);
        const double cross = outer->nx[b] * inner->nx[b] + outer->ny[b] * inner->ny[b];
        const double w_oi = cross * a.inner - a.spin, w_io = cross * a.outer - a.spin;
        const double ahead = over_ring(inner->nx[b], inner->ny[b], inner->second[b], moved);
        outer->driven[b] = driven_o, inner->driven[b] = driven_i, m->cross[b] = cross;
        outer->expected[b] = outer->sliding[b] + driven_o + w_oi * inner->tangential[b];
        inner->expected[b] = inner->sliding[b] + driven_i + w_io * outer->tangential[b] - ahead;
    }
}

/* Put the contacts that press behind the first k of the lines; returns how many there are. */
static inline int64_t gather(int64_t k, int64_t count, double answer, const Race *restrict race,
                             Lines *restrict lines)
{
    for (int64_t b = 0; b < count; b++) {
        lines->normal[k] = race->normal[b], lines->sliding[k] = race->sliding[b];
        lines->expected[k] = race->expected[b], lines->answer[k] = answer;
        k += race->normal[b] > 0.0; /* else the next one takes the place */
    }
    return k;
}

static inline int64_t hand_back(int64_t k, int64_t count, Race *restrict race, const Lines *restrict lines)
{
    for (int64_t b = 0; b < count; b++) {
        const int presses = race->normal[b] > 0.0;
        race->start[b] = presses ? lines->start[k] : 0.0;
        race->slope[b] = presses ? lines->slope[k] : 0.0;
        race->base[b] = presses ? lines->base[k] : 6.0;
        k += presses;
    }
    return k;
}

/* The lines of friction of all contacts that press, in short passes: long ones wait for their results. */
static void draw_lines(Answers a, Bearing *restrict m)
{
    Lines *restrict lines = &m->lines;
    const int64_t count = m->count;
    int64_t k = gather(0, count, a.outer + a.spin, &m->outer, lines);
    const int64_t n = in_full(gather(k, count, a.inner + a.spin, &m->inner, lines));
    const Friction law = m->race_friction;
    for (k = 0; k < n; k++)
        lines->spot[k] = spot(lines->expected[k], lines->answer[k], lines->normal[k], &law);
    for (k = 0; k < n; k++) lines->last[k] = saturation(2.0 * law.slope * fabs(lines->spot[k]));
    for (k = 0; k < n; k++) lines->flat[k] = saturation(2.0 * law.g3 * fabs(lines->spot[k]));
    for (k = 0; k < n; k++) {
        const Line line = line_at(lines->spot[k], lines->last[k], lines->flat[k], lines->sliding[k],
                                  lines->answer[k], lines->normal[k], &law);
        lines->start[k] = line.start, lines->slope[k] = line.slope, lines->base[k] = line.base;
    }
    hand_back(hand_back(0, count, &m->outer, lines), count, &m->inner, lines);
}

/* Friction on each ball as the ring keeps its velocity, and what it gains with that. */
static void join(Answers a, Bearing *restrict m)
{
    Race *inner = &m->inner, *outer = &m->outer;
    const double w_oo = a.outer + a.spin, w_ii = a.inner + a.spin;
    for (int64_t b = 0, n = in_full(m->count); b < n; b++) {
        const double w_oi = m->cross[b] * a.inner - a.spin, w_io = m->cross[b] * a.outer - a.spin;
        const double slope_o = outer->slope[b], slope_i = inner->slope[b];
        const double alone_o = outer->start[b] - slope_o * outer->driven[b];
        const double alone_i = inner->start[b] - slope_i * inner->driven[b];
        const double d_o = outer->base[b] + slope_o * w_oo, d_i = inner->base[b] + slope_i * w_ii;
        const double c_o = slope_o * w_oi, c_i = slope_i * w_io;
        const double inverse = 1.0 / (d_o * d_i - c_o * c_i);
        outer->held[b] = (d_i * alone_o - c_o * alone_i) * inverse;
        inner->held[b] = (d_o * alone_i - c_i * alone_o) * inverse;
        outer->gain[b] = -c_o * slope_i * inverse;
        inner->gain[b] = d_o * slope_i * inverse;
    }
}

typedef struct { double nx, ny, lever, held, gain; } Bore;

/* The ring's three symmetric equations under `push` (with the ring's mass and inertia) and all friction. */
static Moved turn_ring(Total push, Bore bore, const Bearing *m)
{
    const Race *at = &m->inner;
    const double h = m->kick, own = h * bore.gain;
    double xx = own * bore.ny * bore.ny, yy = own * bore.nx * bore.nx, xy = -own * bore.nx * bore.ny;
    double xw = -own * bore.ny * bore.lever, yw = own * bore.nx * bore.lever;
    double ww = own * bore.lever * bore.lever;
    double fx = push.fx + bore.held * bore.ny, fy = push.fy - bore.held * bore.nx;
    double moment = push.moment - bore.held * bore.lever;
    for (int64_t b = 0; b < m->count; b++) {
        const double nx = at->nx[b], ny = at->ny[b], lever = at->second[b];
        const double gain = h * at->gain[b], held = at->held[b], along_x = -gain * ny, along_y = gain * nx;
        xx -= along_x * ny;
        xy += along_x * nx;
        yy += along_y * nx;
        xw += along_x * lever;
        yw += along_y * lever;
        ww += gain * lever * lever;
        fx += held * ny;
        fy -= held * nx;
        moment -= held * lever;
    }
    xx = m->ring_mass + xx, yy = m->ring_mass + yy, ww = m->ring_inertia + ww;
    const double xy_xx = xy / xx, xw_xx = xw / xx;
    yy = yy - xy_xx * xy;
    yw = yw - xy_xx * xw;
    const double yw_yy = yw / yy;
    fy = fy - xy_xx * fx;
    const double spin = (moment - xw_xx * fx - yw_yy * fy) / (ww - xw_xx * xw - yw_yy * yw);
    const double y = fy / yy - yw_yy * spin;
    const double x = fx / xx - xy_xx * y - xw_xx * spin;
    const Moved moved = {h * x, h * y, h * spin};
    return moved;
}

/* The friction at both races as the ring moves, what it and damping heat, and the balls' accelerations. */
static void settle(Answers a, Moved moved, Bearing *restrict m)
{
    Race *inner = &m->inner, *outer = &m->outer;
    Rates *faster = &m->faster;
    const double w_oo = a.outer + a.spin, w_ii = a.inner + a.spin, h = m->kick;
    const double by_mass = 1.0 / m->mass, by_inertia = m->ball_radius / m->inertia;
    for (int64_t b = 0, n = in_full(m->count); b < n; b++) {
        const double w_oi = m->cross[b] * a.inner - a.spin, w_io = m->cross[b] * a.outer - a.spin;
        const double ahead = over_ring(inner->nx[b], inner->ny[b], inner->second[b], moved);
        const double f_o = outer->held[b] + outer->gain[b] * ahead;
        const double f_i = inner->held[b] + inner->gain[b] * ahead;
        const double ds_o = outer->driven[b] + w_oo * f_o + w_oi * f_i;
        const double ds_i = inner->driven[b] + w_io * f_o + w_ii * f_i - ahead;
        const double ax = faster->x[b] - (f_o * outer->ny[b] + f_i * inner->ny[b]) * by_mass;
        const double ay = faster->y[b] + (f_o * outer->nx[b] + f_i * inner->nx[b]) * by_mass;
        const double dx = h * ax, dy = h * ay;
        const double into_o = dx * outer->nx[b] + dy * outer->ny[b];
        const double into_i = (moved.x - dx) * inner->nx[b] + (moved.y - dy) * inner->ny[b];
        outer->tangential[b] = f_o, inner->tangential[b] = f_i;
        const double rubbed_o = -f_o * (outer->sliding[b] + 0.5 * ds_o);
        const double rubbed_i = -f_i * (inner->sliding[b] + 0.5 * ds_i);
        outer->loss[b] = rubbed_o + outer->damped[b] * (outer->rate[b] + 0.5 * into_o);
        inner->loss[b] = rubbed_i + inner->damped[b] * (inner->rate[b] + 0.5 * into_i);
        faster->x[b] = ax, faster->y[b] = ay;
        faster->spin[b] += (f_o - f_i) * by_inertia;
    }
}

#endif
