/* The right-hand side of the detailed bearings, written by hand for comparison: the arithmetic of the
   project's kernels in the order in which they do it, so that results agree, in loops over all balls that
   the compiler turns into vector code. Races are circles, the journal has no elastic modes. SI. */
#include "copies.h"
#include "neighbours.h"
#include "pockets.h"
#include "rubbing.h"

/* ---- balls pressed by both races ---- */

static inline Motion ring_of(const State *q)
{
    const Motion ring = {q->head[RX], q->head[RY], q->head[RVX], q->head[RVY], q->head[RW]};
    return ring;
}

/* All balls at a circular race around `body`, which the kick before changed by (race_x, race_y) (m/s). */
static inline void press_race(const Balls *restrict balls, Motion body, double side, double radius,
                              const Law *law, double race_x, double race_y, Race *restrict race, Bearing *m)
{
    const double reach = side * m->ball_radius, h = m->kick, answer = m->kick / m->mass;
    const Balls *restrict before = &m->before.balls;
    const double stiffness = law->stiffness, damping_law = law->damping;
    for (int64_t b = 0, n = in_full(m->count); b < n; b++) {
        const double dx = balls->x[b] - body.x, dy = balls->y[b] - body.y;
        const double distance = sqrt(dx * dx + dy * dy), inverse = 1.0 / distance;
        const double second = distance + reach, nx = dx * inverse, ny = dy * inverse;
        const double indentation = side * (second - radius);
        const double ux = balls->vx[b] - body.vx, uy = balls->vy[b] - body.vy;
        const double rate = side * (ux * nx + uy * ny);
        const double depth = larger(indentation, 0.0), root = sqrt(depth);
        const double asked = stiffness * depth * root, damping = damping_law * depth;
        const double faster_x = h * before->vx[b] - race_x, faster_y = h * before->vy[b] - race_y;
        const double others = side * (faster_x * nx + faster_y * ny) + answer * race->normal[b];
        const double elastic = passive(asked, 0.4 * indentation, race->stored[b], rate, others, answer,
                                       h, m->drift);
        const double normal = damped_normal(elastic, damping, rate, answer, others);
        race->nx[b] = nx, race->ny[b] = ny, race->indentation[b] = indentation, race->second[b] = second;
        race->normal[b] = normal, race->stiffness[b] = 1.5 * stiffness * root;
        race->damped[b] = normal - elastic, race->rate[b] = rate;
        race->sliding[b] = uy * nx - ux * ny + balls->spin[b] * reach - body.spin * second;
    }
}

/* Both races press all balls; sets their accelerations, with gravity. */
static void press_races(const State *restrict q, Bearing *restrict m)
{
    const double h = m->kick, by_mass = 1.0 / m->mass, gravity = m->gravity;
    const Motion housing = {q->head[HX], q->head[HY], q->head[HVX], q->head[HVY], 0.0};
    const double ring_x = h * m->before.head[RVX], ring_y = h * m->before.head[RVY];
    const Motion ring = ring_of(q);
    press_race(&q->balls, housing, INSIDE, m->outer_radius, &m->outer_law, 0.0, 0.0, &m->outer, m);
    press_race(&q->balls, ring, OUTSIDE, m->inner_radius, &m->inner_law, ring_x, ring_y, &m->inner, m);
    const Race *inner = &m->inner, *outer = &m->outer;
    for (int64_t b = 0, n = in_full(m->count); b < n; b++) {
        m->faster.x[b] = (inner->normal[b] * inner->nx[b] - outer->normal[b] * outer->nx[b]) * by_mass;
        m->faster.y[b] =
            (inner->normal[b] * inner->ny[b] - outer->normal[b] * outer->ny[b]) * by_mass - gravity;
        m->faster.spin[b] = 0.0;
    }
}

/* ---- journal and ring ---- */

/* The journal in the bore: its place, its kick with the ring answering alone, and what presses it. */
static Squeeze meet_journal(const State *q, const Bearing *m, Place *at, Kick *kick)
{
    const double *z = q->head, *a = m->before.head;
    const Motion journal = {z[JX], z[JY], z[JVX], z[JVY], z[JW]}, kept = {0.0, 0.0, 0.0, 0.0, 0.0};
    const double ex = z[JX] - z[RX], ey = z[JY] - z[RY], distance = sqrt(ex * ex + ey * ey);
    const double inverse = distance > 0.0 ? 1.0 / distance : 0.0, along = 1.0 / m->ring_mass;
    *at = (Place){ex * inverse, ey * inverse, distance - m->clearance, m->journal_radius,
                  distance + m->journal_radius};
    const Motion ring = {a[RX], a[RY], a[RVX], a[RVY], a[RW]};
    const double across = along + at->second * at->second / m->ring_inertia;
    *kick = kick_of(m->kick, across, along, kept, ring, *at, INSIDE, m->rubbed, m->ring.normal);
    Squeeze s;
    double elastic, damping;
    slip(journal, ring_of(q), *at, INSIDE, &s.sliding, &s.rate);
    elastic_and_damping(at->indentation, &m->contact, &elastic, &damping);
    elastic = passive(elastic, at->indentation / 2.5, m->ring.stored, s.rate, kick->rate, kick->along,
                      m->kick, m->drift);
    s.normal = damped_normal(elastic, damping, s.rate, kick->along, kick->rate);
    s.damped = s.normal - elastic;
    return s;
}

static Bore bore_line(Place at, Kick kick, Squeeze s, const Bearing *m)
{
    Bore bore = {at.nx, at.ny, at.second, 0.0, 0.0};
    if (s.normal <= 0.0) return bore;
    const Line line = line_of(s.sliding, s.sliding + kick.sliding, kick.across, s.normal, &m->friction);
    bore.held = line.start / line.base, bore.gain = line.slope / line.base;
    return bore;
}

/* The journal's friction (N) over the kick that moves the ring; adds its heat (W) to `heat`. */
static Press rub_journal(Place at, Squeeze s, double friction, Moved moved, double *heat, Bearing *m)
{
    const Press press = rubbed(at, INSIDE, s, friction);
    const double ahead = -over_ring(at.nx, at.ny, at.second, moved), elastic = s.normal - s.damped;
    const double into = -(moved.x * at.nx + moved.y * at.ny);
    *heat = s.damped * (s.rate + 0.5 * into) - friction * (s.sliding + 0.5 * ahead);
    m->ring = (Touched){s.normal, at.indentation, s.rate, elastic, s.rate + 0.5 * into, at.nx, at.ny,
                        m->ring.stored};
    m->rubbed = friction;
    m->brake.jx = press.fx + elastic * at.nx, m->brake.jy = press.fy + elastic * at.ny;
    m->brake.jm = press.first_moment;
    return press;
}

static Total pressing(const Race *race, double side, int64_t count)
{
    Total total = {0.0, 0.0, 0.0, 0.0};
    for (int64_t b = 0; b < count; b++) {
        const double along = side * race->normal[b];
        total.fx += along * race->nx[b];
        total.fy += along * race->ny[b];
    }
    return total;
}

static Total with_friction(Total total, const Race *race, int64_t count)
{
    for (int64_t b = 0; b < count; b++) {
        total.fx += race->tangential[b] * race->ny[b];
        total.fy -= race->tangential[b] * race->nx[b];
        total.moment -= race->tangential[b] * race->second[b];
        total.loss += race->loss[b];
    }
    return total;
}

/* ---- all of it ---- */

/* The balls' derivatives. */
static void hand_over(const Balls *restrict q, Balls *restrict dq, const Rates *restrict faster,
                      int64_t count)
{
    for (int64_t b = 0, n = in_full(count); b < n; b++) {
        dq->x[b] = q->vx[b], dq->y[b] = q->vy[b], dq->angle[b] = q->spin[b];
        dq->vx[b] = faster->x[b], dq->vy[b] = faster->y[b], dq->spin[b] = faster->spin[b];
    }
}

/* Derivative dq of all that the bearing integrates, t (s) into the macro step. */
static __attribute__((noinline)) void rhs(double t, const State *restrict q, State *restrict dq,
                                          Bearing *restrict m)
{
    const double h = m->kick, *before = m->before.head;
    const int64_t count = m->count;
    press_races(q, m);
    int touching = 0;
    Turned by = {1.0, 0.0};
    if (m->caged) by = press_pockets(q, dq, m);
    else touching = press_all_neighbours(q, m);
    const Total pressed = pressing(&m->inner, OUTSIDE, count);
    const Total pressed_out = pressing(&m->outer, INSIDE, count);
    const Answers answers = {h / m->mass, h / m->mass, h * m->ball_radius * m->ball_radius / m->inertia};
    const Moved last = {h * before[RVX], h * before[RVY], h * before[RW]};
    Place at;
    Kick kick;
    const Squeeze s = meet_journal(q, m, &at, &kick);
    const Bore bore = bore_line(at, kick, s, m);
    const Total on_ring = {pressed.fx + s.normal * at.nx,
                           pressed.fy + s.normal * at.ny - m->ring_mass * m->gravity, pressed.moment, 0.0};
    drive(answers, last, m);
    draw_lines(answers, m);
    join(answers, m);
    const Moved moved = turn_ring(on_ring, bore, m);
    settle(answers, moved, m);
    double heat;
    const double friction = bore.held + bore.gain * over_ring(bore.nx, bore.ny, bore.lever, moved);
    const Press j = rub_journal(at, s, friction, moved, &heat, m);
    hand_over(&q->balls, &dq->balls, &m->faster, count);
    const Total inner = with_friction(pressed, &m->inner, count);
    const Total outer = with_friction(pressed_out, &m->outer, count);
    m->brake.hx = outer.fx - pressed_out.fx, m->brake.hy = outer.fy - pressed_out.fy;
    double *z = dq->head;
    z[RX] = q->head[RVX], z[RY] = q->head[RVY], z[RANGLE] = q->head[RW];
    z[RVX] = (inner.fx - j.fx) / m->ring_mass;
    z[RVY] = (inner.fy - j.fy) / m->ring_mass - m->gravity;
    z[RW] = (j.second_moment + inner.moment) / m->ring_inertia;
    const double beside = m->caged ? heat_in_pockets(dq, by, m) : touching ? heat_between(dq, m) : 0.0;
    z[LOSS] = heat + inner.loss + outer.loss + beside;
    const Load load = {j.fx, j.fy, j.first_moment, outer.fx, outer.fy};
    copy_rates(t, q->head, z, load, m);
    book(z, load, m);
}

/* The right-hand side `times` over; each turn starts from the forces that the one before it left. */
void repeat(const State *q, State *dq, Bearing *m, int64_t times)
{
    for (int64_t i = 0; i < times; i++) rhs(0.0, q, dq, m);
}

int64_t size_of_bearing(void) { return sizeof(Bearing); }
