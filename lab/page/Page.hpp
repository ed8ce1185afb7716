#pragma once
/** @file Page.hpp
 * What the web page calls: one Live scene, and what there is to draw of it.
 * Functions of C, as WebAssembly knows no other: numbers, and pointers that
 * hold until the next call. All of them are exported: page.mk.
 *
 * Scenes and methods are numbered as page_about() lists them, nodes by id. Side
 * 0 is the scene, side 1 the one beside it while page_compare() runs.
 * What throws ends a call: wasi.cpp. */

#include "CME212/Point.hpp"

extern "C" {

/** The scenes and the methods: a JSON text. */
const char* page_about();

/** A scene of side x side nodes at t = 0, by a method.
 * @pre side >= 2 */
void page_load(unsigned scene, unsigned side, unsigned method);
/** What stands around its cloth, and the corners of what to look at: a JSON
 * text. */
const char* page_setting();
/** dt / limit: SetStepShare.  @pre share > 0 */
void page_set_share(double share);
void page_set_method(unsigned method);
/** [N/m], [kg/s], [m/s^2]; by area where the scene has that: SetStiffness,
 * SetDrag. */
void page_set_stiffness(double K);
void page_set_drag(double c);
void page_set_gravity(double g);
/** A copy of the present state beside it, by another method; -1: alone again.
 */
void page_compare(int method, double share);

void page_grab(unsigned node, double x, double y, double z);
void page_move_hand(double x, double y, double z);
void page_release();
/** Pin a node where it is; or let go of it, if it is pinned. */
void page_toggle_pin(unsigned node);
/** Room for @a rays rays of six numbers, near x y z, far x y z [m]; and cut the
 * edges that a stroke through them crosses. */
double* page_stroke(unsigned rays);
void page_cut(unsigned rays);

/** A step of side 0, and side 1 up to the same time; the first one after a
 * failure does nothing.  @return its time [s] */
double page_step();
/** Look at the state before it is drawn: Live::check().
 * @return 1 if it failed */
int page_check();
/** What happened to a side that failed; empty: it runs. */
const char* page_failure(unsigned side);
/** Live::readings() as a JSON text. Of a scene that failed: up to some seconds,
 * to find what works. */
const char* page_readings(int sharp);

/** Slots of nodes of a side; 0: there is no such side. */
unsigned page_slots(unsigned side);
/** Positions [m], three numbers a slot; doubles where the page is built. */
const Real* page_positions(unsigned side);
/** What is drawn, as page_points() and page_mesh() were called last: a side
 * that failed is drawn some steps later, had nobody stopped it.
 * x y z [m] and the largest strain of a spring there, four numbers a slot. */
const float* page_points(unsigned side);
/** Counts up when page_mesh() would give another one. */
double page_version(unsigned side);
/** Number of springs, of triangles, of pinned nodes; then two ids a spring,
 * three a triangle, one a pinned node. */
const unsigned* page_mesh(unsigned side);
/** The node at which a side failed; -1: none. */
int page_failed_node(unsigned side);
}
