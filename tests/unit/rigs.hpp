// The rigs that the unit tests use.
#pragma once

#include "pongeye.h"

// The paper's rig: f 1081 px, 0.18 m baseline, 0.4 m behind the table's end, 0.5 m above it, pitched 13 degrees down.
pong_rig test_rig();
