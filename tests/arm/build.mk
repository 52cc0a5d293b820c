# The library and its unit tests as 64-bit ARM runs them; included by the top Makefile. Debian's compiler for it builds
# them, and qemu runs them.
#   make test-arm

ARM_DEBIAN_PACKAGES := g++-aarch64-linux-gnu qemu-user-static googletest
ARM_TESTS := region camera detect detect_hard cell_sums lit_cells fresh locate locate_border light doubt closer match \
	reconstruct physics estimate track predict
ARM_BUILD := $(BUILD)-arm

.PHONY: test-arm
test-arm: deps
	@$(MAKE) --no-print-directory deps DEBIAN_PACKAGES="$(ARM_DEBIAN_PACKAGES)"
	@$(MAKE) --no-print-directory $(ARM_BUILD)/tests/arm BUILD=$(ARM_BUILD) CXX=aarch64-linux-gnu-g++ \
	    AR=aarch64-linux-gnu-ar LDFLAGS=-static
	qemu-aarch64-static $(ARM_BUILD)/tests/arm --gtest_brief=1

# There is no gtest of another processor to be installed: it is built from its sources.
GTEST_SOURCES := /usr/src/googletest/googletest
$(BUILD)/obj/gtest/%.o: $(GTEST_SOURCES)/src/%.cc
	$(begin)
	$(Q)$(CXX) -O1 -I$(GTEST_SOURCES) -c $< -o $@

# The truth of flights is the simulator's.
$(BUILD)/tests/arm: $(ARM_TESTS:%=$(BUILD)/obj/tests/unit/test_%.o) $(BUILD)/obj/tests/unit/pictures.o \
    $(BUILD)/obj/tests/unit/rigs.o $(addprefix $(BUILD)/obj/tools/simulate/,ball.o flight.o) \
    $(BUILD)/obj/gtest/gtest-all.o $(BUILD)/obj/gtest/gtest_main.o $(BUILD)/lib/libpongeye.a
	$(begin)
	$(Q)$(CXX) $(LDFLAGS) $^ -pthread -o $@
