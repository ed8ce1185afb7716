#pragma once
/** @file Page.hpp
 * What the web page calls: one Live scene, and what there is to draw of it.
 * These are C functions, since WebAssembly has no others. A pointer that one
 * returns is valid until the next call. page.mk exports all of them.
 *
 * Scenes are numbered as page_about() lists them, nodes by id. Side 0 is the
 * scene; side 1 is the second scene that the request `compare` starts.
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
/** Live::apply().  @return what is wrong with the text; "" if nothing */
const char* page_request(const char* text);
/** Live::recording(), but without the scene. */
const char* page_recording();

/** A step of side 0, and side 1 up to the same time; the first one after a
 * failure does nothing.  @return its time [s] */
double page_step();
/** Check the state before it is drawn: Live::check().
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
/** x y z [m] and the largest strain of a spring there, four numbers a slot. A
 * side that failed is drawn as it would be some steps later. */
const float* page_points(unsigned side);
/** Counts up when page_mesh() would return another mesh. */
double page_version(unsigned side);
/** Number of springs, of triangles, of pinned nodes; then two ids a spring,
 * three a triangle, one a pinned node. */
const unsigned* page_mesh(unsigned side);
/** The node at which a side failed; -1: none. */
int page_failed_node(unsigned side);
}
