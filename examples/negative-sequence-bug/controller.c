/* The bundled controller with one mistake in it: its current references are made as if there was no negative sequence.
 *
 * In a balanced sag nobody notices. In an unbalanced one the power, and with it the voltage of the DC link, swings at
 * twice the grid's frequency. Delete the line that is marked, and it is mended.
 */
#include "../bundled-controller-c/current_references.h"

#define current_references(u_pos, u_neg, P_ref, Q_ref, p) current_references(u_pos, 0.0, P_ref, Q_ref, p) /* mistake */

#include "../bundled-controller-c/controller.c"
