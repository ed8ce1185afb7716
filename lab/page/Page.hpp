#pragma once
/** @file Page.hpp
 * The functions that the web page calls: one Live scene and its drawing. They
 * are C functions, since WebAssembly has no others. A pointer that one
 * returns is valid until the next call. page.mk exports all of them.
 *
 * Scenes are numbered as page_about() lists them, nodes by id. Side 0 is the
 * scene; sides 1 to 3 are the scenes that the request `compare` starts.
 * A call that throws ends there: wasi.cpp. */

#include "CME212/Point.hpp"

extern "C" {

/** The scenes and the methods: a JSON text. */
const char* page_about();

/** A scene of side x side nodes at t = 0, by verlet.
 * @pre side >= 2 */
void page_load(unsigned scene, unsigned side);
/** The obstacles around its cloth, and the corners of the box to look at: a
 * JSON text. */
const char* page_setting();
/** A buffer of @a size bytes, into which the caller writes a text. */
char* page_room(unsigned size);
/** Live::apply().  @return the error in the text; "" if there is none */
const char* page_request(const char* text);
/** Live::recording() */
const char* page_recording();

/** A step of side 0, and the others up to the same time; the first one after a
 * failure does nothing.  @return its time [s] */
double page_step();
/** Check the state before it is drawn: Live::check().
 * @return 1 if it failed */
int page_check();
/** How a side failed, a JSON text: whether it diverged, cause and place, two
 * sentences. null: it runs. */
const char* page_failure(unsigned side);
/** Draw a side that failed as it is so many steps after its last good state.
 * O(steps) since the last call.  @return its time then [s], which stays the
 * same if there are no more steps  @pre page_failure(side) is not null */
double page_beyond(unsigned side, unsigned steps);
/** Why side 0 failed: cause and remedy, two sentences, and a cure, its method
 * and share of dt_unit(), or null: a JSON text. Takes up to some seconds.
 * @pre page_failure(0) is not null */
const char* page_explain();
/** Live::readings() as a JSON text, and the present value of the scene's
 * measure, if that is a number or three. */
const char* page_readings(int sharp);

/** Slots of nodes of a side; 0: there is no such side. */
unsigned page_slots(unsigned side);
/** Positions [m], three numbers a slot; doubles where the page is built. */
const double* page_positions(unsigned side);
/** x y z [m] and the largest strain of a spring there, four numbers a slot. */
const float* page_points(unsigned side);
/** Counts up when page_mesh() would return another mesh. */
double page_version(unsigned side);
/** Number of springs, of triangles, of pinned nodes; then two ids a spring,
 * three a triangle, one a pinned node. */
const unsigned* page_mesh(unsigned side);
/** The node at which a side failed; -1: none. */
int page_failed_node(unsigned side);
}
