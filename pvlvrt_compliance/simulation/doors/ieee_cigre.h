/* The header lies in controllers/library. Makefiles of projects from before that point the compiler to this folder
 * (INTERFACE = .../pvlvrt_compliance/simulation/doors), and are to go on building.
 */
#include "../../controllers/library/ieee_cigre.h"
