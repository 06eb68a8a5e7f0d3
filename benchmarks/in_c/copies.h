/* The copies of journal and housing that the bearing carries, and what they gather. SI. */
#ifndef COPIES_H
#define COPIES_H

#include "contact.h"

typedef struct { double jx, jy, jm, hx, hy; } Load;

/* Derivatives of the copies and of what they gather, t (s) into the macro step. */
static void copy_rates(double t, const double *restrict q, double *restrict dq, Load load, const Bearing *m)
{
    const Journal *j = &m->journal;
    const Housing *h = &m->housing;
    const double s = t - m->half;
    dq[JX] = q[JVX], dq[JY] = q[JVY];
    dq[JVX] = j->ax_free + j->inv_m * load.jx, dq[JVY] = j->ay_free + j->inv_m * load.jy;
    dq[JW] = j->alpha_free + j->inv_I * load.jm;
    dq[JPX] = load.jx, dq[JPY] = load.jy, dq[JPM] = load.jm;
    dq[JQX] = s * load.jx, dq[JQY] = s * load.jy, dq[JQM] = s * load.jm;
    dq[JE] = load.jx * dq[JX] + load.jy * dq[JY] + load.jm * q[JW];
    dq[HX] = q[HVX], dq[HY] = q[HVY];
    const double spring_x = h->k_over_m * (q[HX] - h->x) + h->c_over_m * (q[HVX] - h->vx);
    const double spring_y = h->k_over_m * (q[HY] - h->y) + h->c_over_m * (q[HVY] - h->vy);
    dq[HVX] = h->ax_free + h->inv_m * load.hx - spring_x;
    dq[HVY] = h->ay_free + h->inv_m * load.hy - spring_y;
    dq[HPX] = load.hx, dq[HPY] = load.hy;
    dq[HFX] = q[HFVX], dq[HFY] = q[HFVY];
    dq[HFVX] = load.hx - h->k_over_m * q[HFX] - h->c_over_m * q[HFVX];
    dq[HFVY] = load.hy - h->k_over_m * q[HFY] - h->c_over_m * q[HFVY];
    dq[HE] = load.hx * dq[HX] + load.hy * dq[HY];
}

/* Have the copies' work and heat be that of the middle of the kick. */
static void book(double *dq, Load load, const Bearing *m)
{
    const double h = 0.5 * m->kick, *ahead = m->ahead;
    const Brake *b = &m->brake;
    const double jx = h * dq[JVX] - ahead[0], jy = h * dq[JVY] - ahead[1], jw = h * dq[JW] - ahead[2];
    const double hx = h * dq[HVX] - ahead[3], hy = h * dq[HVY] - ahead[4];
    dq[JE] += load.jx * jx + load.jy * jy + load.jm * jw;
    dq[HE] += load.hx * hx + load.hy * hy;
    dq[LOSS] -= b->jx * jx + b->jy * jy + b->jm * jw + b->hx * hx + b->hy * hy;
}

#endif
