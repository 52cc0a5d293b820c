// How often this program has asked for memory, so that a test can show that the steady loop never does.
#pragma once

long allocations();
