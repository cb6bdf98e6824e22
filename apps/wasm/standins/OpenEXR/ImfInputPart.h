#include <OpenEXR/ImfStandIn.h>
