# Pongeye. What to type:
#   make           build the library and every program into build/
#   make test      install what is missing, build, run the tests
#   make demo      install what is missing, build, watch the tracker follow simulated cameras
#   make install   into PREFIX (/usr/local), with DESTDIR for packagers
#   make help      the rest

BUILD  ?= build
PREFIX ?= /usr/local
VERSION := $(shell sed -n 's/^.define PONG_VERSION "\(.*\)"/\1/p' lib/pongeye.h)

# The library, in the order of the data.
LIB := \
	error document \
	rig camera settings \
	calibrate_linear calibrate_model calibrate_start calibrate_solve calibrate_error calibrate_refine calibrate \
	region \
	cells cell_memory conditions cell_sums patch lit_cells five_points blob outline fresh circles \
	detect_difference detect_double detect \
	cone locate_gaussian locate_centroid locate_edges tangent sphere lamp ball_pixels light locate_photometric locate \
	reconstruct \
	flight physics trajectory noise estimate halves track \
	outlook predict \
	window \
	doubt side expect closer match trust eye

# The programs, each a folder of tools/, and the packages that each needs.
PROGRAMS := calibrate track predict simulate bench
PACKAGES_lib      := eigen3
PACKAGES_calibrate := eigen3 aravis-0.8
PACKAGES_track    := aravis-0.8 lcm
PACKAGES_simulate := eigen3
PACKAGES_bench    := eigen3
OPENCV_calibrate  := -lopencv_calib3d -lopencv_imgcodecs -lopencv_imgproc -lopencv_core
OPENCV_track      := -lopencv_imgcodecs -lopencv_core
OPENCV_simulate   := -lopencv_imgcodecs -lopencv_imgproc -lopencv_core
OPENCV_bench      := -lopencv_imgcodecs -lopencv_calib3d -lopencv_imgproc -lopencv_core

# The benchmark flies and pictures the simulator's balls, and reads flights as pongeye-predict does.
BORROWED_bench := $(patsubst %,$(BUILD)/obj/tools/simulate/%.o,ball flight serve camera backdrop board lens people \
	renderer room scene section sensor sphere texture world) \
	$(patsubst %,$(BUILD)/obj/tools/predict/%.o,points follow fit)

# What Debian and Ubuntu call what we need.
DEBIAN_PACKAGES := pkg-config libeigen3-dev libtomlplusplus-dev libopencv-dev libaravis-dev liblcm-dev liblcm-bin \
	liblcm-java libjchart2d-java default-jdk-headless libgtest-dev iproute2 netpbm

OPTIMISE ?= -O3 -g
WARNINGS := -Wall -Wextra -Wshadow $(if $(WERROR),-Werror)
SANITIZE_FLAGS := $(if $(SANITIZE),-fsanitize=$(SANITIZE) -fno-sanitize-recover=all -fno-omit-frame-pointer)
COMMON_FLAGS := $(OPTIMISE) $(WARNINGS) $(SANITIZE_FLAGS) -fPIC -fno-math-errno -fno-trapping-math \
	-fvisibility=hidden -MMD -MP -Ilib
# A malformed file is no reason to abort: where toml++ asserts what a file must be, its next lines refuse it properly.
COMMON_FLAGS += -UNDEBUG '-DTOML_ASSERT(condition)=static_cast<void>(0)'
override CFLAGS   += -std=c11 $(COMMON_FLAGS)
override CXXFLAGS += -std=c++17 $(COMMON_FLAGS)
override LDFLAGS  += $(SANITIZE_FLAGS)

# Flags of packages; asked for only when something is compiled, after `make deps` may have installed them. As system
# headers, so that our warnings are about our own code.
cflags = $(patsubst -I%,-isystem %,$(if $(strip $(1)),$(shell pkg-config --cflags $(1))))
libs   = $(if $(strip $(1)),$(shell pkg-config --libs $(1)))

# As many jobs as there are processors; a line for each thing made, or with V=1 the whole commands.
MAKEFLAGS += --jobs=$(shell nproc)
Q := $(if $(V),,@)
begin = @mkdir -p $(@D)$(if $(V),,; echo "  $@")

.PHONY: all
all: $(BUILD)/lib/libpongeye.a $(BUILD)/lib/libpongeye.so $(BUILD)/lib/libpongeye-lcmtypes.a $(BUILD)/lib/pongeye.jar \
     $(PROGRAMS:%=$(BUILD)/bin/pongeye-%) $(BUILD)/bin/pongeye-spy

# --- Dependencies

SUDO := $(if $(filter 0,$(shell id -u)),,sudo)

.PHONY: deps
deps:
	@missing=; for package in $(DEBIAN_PACKAGES); do \
	    dpkg-query -W -f '$${Status}' $$package 2>/dev/null | grep -q 'ok installed' || missing="$$missing $$package"; \
	done; \
	if [ -n "$$missing" ]; then \
	    echo "Installing what is missing:$$missing"; \
	    $(SUDO) apt-get update -qq && \
	    $(SUDO) env DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends $$missing; \
	fi

# --- The library

LIB_OBJECTS := $(LIB:%=$(BUILD)/obj/lib/%.o)

$(BUILD)/obj/lib/%.o: lib/%.cpp
	$(begin)
	$(Q)$(CXX) $(CPPFLAGS) $(CXXFLAGS) $(call cflags,$(PACKAGES_lib)) -c $< -o $@

$(BUILD)/lib/libpongeye.a: $(LIB_OBJECTS)
	$(begin)
	$(Q)$(AR) rcs $@ $^

$(BUILD)/lib/libpongeye.so: $(LIB_OBJECTS)
	$(begin)
	$(Q)$(CXX) -shared -Wl,-soname,libpongeye.so.0 $(LDFLAGS) $^ -o $@

# --- The messages. lcm-gen fails without its output folder, and exits 0 all the same.

LCMTYPES := $(wildcard lcmtypes/*.lcm)
LCM_HPP  := $(LCMTYPES:lcmtypes/%.lcm=$(BUILD)/lcmtypes/pongeye/%.hpp)

$(BUILD)/lcmtypes/pongeye/%.hpp: lcmtypes/%.lcm
	@mkdir -p $(@D) $(BUILD)/lcmtypes/c
	$(Q)lcm-gen --cpp --cpp-std c++11 --cpp-hpath $(BUILD)/lcmtypes $<
	$(Q)lcm-gen --c --c-cpath $(BUILD)/lcmtypes/c --c-hpath $(BUILD)/lcmtypes/c $<
	@test -s $@

# For robots in C: the messages' encoders, to be linked with lcm.
$(BUILD)/lib/libpongeye-lcmtypes.a: $(LCM_HPP)
	$(begin)
	$(Q)cd $(BUILD)/lcmtypes/c && $(CC) -std=gnu11 -O2 -fPIC $(call cflags,lcm) -c *.c
	$(Q)$(AR) rcs $@ $(BUILD)/lcmtypes/c/*.o

$(BUILD)/lib/pongeye.jar: $(LCMTYPES)
	@mkdir -p $(BUILD)/lcmtypes/java/classes $(@D)
	$(Q)lcm-gen --java --jpath $(BUILD)/lcmtypes/java $^
	$(Q)javac -cp /usr/share/java/lcm.jar -d $(BUILD)/lcmtypes/java/classes $(BUILD)/lcmtypes/java/pongeye/*.java
	$(Q)jar cf $@ -C $(BUILD)/lcmtypes/java/classes .

# --- The programs

COMMON_OBJECTS := $(patsubst %.cpp,$(BUILD)/obj/%.o,$(wildcard tools/common/*.cpp))

$(BUILD)/obj/tools/common/%.o: tools/common/%.cpp
	$(begin)
	$(Q)$(CXX) $(CPPFLAGS) $(CXXFLAGS) -c $< -o $@

# The objects of a program, without its main: tests link these too.
objects_of = $(patsubst %.cpp,$(BUILD)/obj/%.o,$(filter-out %/main.cpp,$(shell find tools/$(1) -name '*.cpp' 2>/dev/null | sort)))

define program
$(BUILD)/obj/tools/$(1)/%.o: tools/$(1)/%.cpp
	$$(begin)
	$$(Q)$$(CXX) $$(CPPFLAGS) $$(CXXFLAGS) -I$(BUILD)/lcmtypes -Itools -Itools/common -Itools/$(1) \
	    $$(call cflags,$$(PACKAGES_$(1)) $$(if $$(OPENCV_$(1)),opencv4)) -c $$< -o $$@

$(if $(filter lcm,$(PACKAGES_$(1))),$(BUILD)/obj/tools/$(1)/main.o $(call objects_of,$(1)): | $(LCM_HPP))

$(BUILD)/bin/pongeye-$(1): $(BUILD)/obj/tools/$(1)/main.o $(call objects_of,$(1)) $(BORROWED_$(1)) $(COMMON_OBJECTS) \
    $(BUILD)/lib/libpongeye.a
	$$(begin)
	$$(Q)$$(CXX) $$(LDFLAGS) $$^ $$(call libs,$$(PACKAGES_$(1))) $$(OPENCV_$(1)) -pthread -o $$@
endef
$(foreach name,$(PROGRAMS),$(eval $(call program,$(name))))

# Live calibration looks through the tracker's cameras.
$(BUILD)/bin/pongeye-calibrate: $(addprefix $(BUILD)/obj/tools/track/,aravis_camera.o cameras.o capture_settings.o clock.o \
	pairing.o presence.o pulse_counter.o pulse_numbering.o realtime.o seat.o)

# The benchmark of calibration finds corners as calibration does.
$(BUILD)/bin/pongeye-bench: $(addprefix $(BUILD)/obj/tools/calibrate/,corners.o pictures.o)

$(BUILD)/bin/pongeye-spy: tools/spy/pongeye-spy
	$(begin)
	sed 's/@VERSION@/$(VERSION)/' $< >$@
	chmod 755 $@

# --- Tests: one binary of unit tests, which links the library and every program but its main, and scripts that run the
# programs as a user would.

UNIT_OBJECTS := $(patsubst %.cpp,$(BUILD)/obj/%.o,$(wildcard tests/unit/*.cpp)) \
	$(patsubst %.c,$(BUILD)/obj/%.o,$(wildcard tests/unit/*.c))
TOOL_OBJECTS := $(foreach name,$(PROGRAMS),$(call objects_of,$(name)))
TEST_PACKAGES := $(sort $(PACKAGES_lib) $(foreach name,$(PROGRAMS),$(PACKAGES_$(name))))
# Quoted headers are looked for in the tools before the library, whose own ones are not meant for others.
TEST_INCLUDES := -I. -Itools -I$(BUILD)/lcmtypes $(addprefix -iquote tools/,common $(PROGRAMS))

# Tests are compiled without much optimisation: more time goes into compiling than into running them.
$(BUILD)/obj/tests/%.o: tests/%.cpp | $(LCM_HPP)
	$(begin)
	$(Q)$(CXX) $(CPPFLAGS) $(CXXFLAGS) -O1 $(TEST_INCLUDES) $(call cflags,$(TEST_PACKAGES) opencv4) -c $< -o $@

$(BUILD)/obj/tests/%.o: tests/%.c
	$(begin)
	$(Q)$(CC) $(CPPFLAGS) $(CFLAGS) -c $< -o $@

$(BUILD)/tests/unit: $(UNIT_OBJECTS) $(TOOL_OBJECTS) $(COMMON_OBJECTS) $(BUILD)/lib/libpongeye.a
	$(begin)
	$(Q)$(CXX) $(LDFLAGS) $^ $(call libs,$(TEST_PACKAGES)) $(sort $(foreach name,$(PROGRAMS),$(OPENCV_$(name)))) \
	    -lgtest -lgtest_main -pthread -o $@

# Programs that the scripts use.
$(BUILD)/tests/lcm_listener: $(BUILD)/obj/tests/sim/lcm_listener.o $(COMMON_OBJECTS)
	$(begin)
	$(Q)$(CXX) $(LDFLAGS) $^ $(call libs,lcm) -o $@

$(BUILD)/tests/gige_aravis: $(BUILD)/obj/tests/sim/test_gige_aravis.o \
    $(patsubst %.cpp,$(BUILD)/obj/%.o,$(wildcard tools/simulate/gige/*.cpp)) $(COMMON_OBJECTS)
	$(begin)
	$(Q)$(CXX) $(LDFLAGS) $^ $(call libs,aravis-0.8) -lgtest -lgtest_main -pthread -o $@

$(BUILD)/tests/latency_probe: $(BUILD)/obj/tests/sim/latency_probe.o $(BUILD)/obj/tools/track/realtime.o $(COMMON_OBJECTS)
	$(begin)
	$(Q)$(CXX) $(LDFLAGS) $^ $(call libs,aravis-0.8) -pthread -o $@

SIM_PROGRAMS := $(BUILD)/tests/lcm_listener $(BUILD)/tests/gige_aravis

.PHONY: test check
test: deps
	$(MAKE) check
	$(MAKE) test-trigger

check: all $(BUILD)/tests/unit $(SIM_PROGRAMS)
	BUILD=$(BUILD) tests/run

# --- Demo, installation

.PHONY: demo install
demo: deps
	$(MAKE) all
	BUILD=$(BUILD) tools/demo/pongeye-demo

INSTALL_DIR := $(DESTDIR)$(PREFIX)

install: all
	install -d $(addprefix $(INSTALL_DIR)/,bin include/pongeye lib/pkgconfig share/java share/pongeye/lcmtypes)
	install -m 755 $(addprefix $(BUILD)/bin/pongeye-,$(PROGRAMS) spy trigger) $(INSTALL_DIR)/bin
	install -m 644 lib/pongeye.h $(INSTALL_DIR)/include
	install -m 644 $(BUILD)/lcmtypes/c/*.h $(LCM_HPP) $(INSTALL_DIR)/include/pongeye
	install -m 644 $(BUILD)/lib/libpongeye.a $(BUILD)/lib/libpongeye-lcmtypes.a $(INSTALL_DIR)/lib
	install -m 755 $(BUILD)/lib/libpongeye.so $(INSTALL_DIR)/lib/libpongeye.so.$(VERSION)
	ln -sf libpongeye.so.$(VERSION) $(INSTALL_DIR)/lib/libpongeye.so.0
	ln -sf libpongeye.so.0 $(INSTALL_DIR)/lib/libpongeye.so
	install -m 644 $(BUILD)/lib/pongeye.jar $(INSTALL_DIR)/share/java
	install -m 644 $(LCMTYPES) $(INSTALL_DIR)/share/pongeye/lcmtypes
	sed 's|/usr/local|$(PREFIX)|' tools/track/pongeye-track.service >$(INSTALL_DIR)/share/pongeye/pongeye-track.service
	sed 's|@PREFIX@|$(PREFIX)|; s|@VERSION@|$(VERSION)|' lib/pongeye.pc.in >$(INSTALL_DIR)/lib/pkgconfig/pongeye.pc
	$(if $(DESTDIR),,-ldconfig 2>/dev/null)

-include $(shell find $(BUILD)/obj -name '*.d' 2>/dev/null)

# --- The rest

.PHONY: help sanitize tsan soak latency loss format lint clean
help:
	@sed -n '2,/^$$/s/^# \{0,1\}//p' Makefile
	@echo "  make check      the tests, without installing anything"
	@echo "  make deps       the packages that are missing; make test and make demo begin with it"
	@echo "  make firmware   the trigger's microcontroller;  make flash PORT=/dev/ttyACM0: onto a board"
	@echo "  make test-trigger   the firmware in an emulator, and the tracker triggered by it"
	@echo "  make test-hil   pongeye-trigger in a virtual machine with GPIO lines and USB"
	@echo "  make sanitize   the tests under AddressSanitizer and UndefinedBehaviorSanitizer; SUITE=faults: others"
	@echo "  make tsan       the unit tests under ThreadSanitizer"
	@echo "  make soak       the tracker under random faults, for MINUTES=10"
	@echo "  make latency    how long the tracker takes from the last packet to the message"
	@echo "  make loss       what 0.1 % of the packets, when they are lost, cost in pairs"
	@echo "  make fuzz       any bytes into every parser, under sanitizers, 20 s each; FUZZ_SECONDS=300: longer"
	@echo "  make fuzz-kept  only the inputs in tests/fuzz/corpus, each once"
	@echo "  make test-arm   unit tests of the library for 64-bit ARM, run by qemu"
	@echo "  make format     clang-format on every file;  make lint: clang-tidy"
	@echo "  make clean      remove build/"
	@echo "  V=1 shows the commands; CC=clang CXX=clang++ BUILD=build-clang WERROR=1: another compiler and folder"

# What meets outside bytes and pictures, in the programs themselves. The simulator stays as it is: it could not serve
# its cameras in time, and its parts are in the unit tests.
SANITIZED := track calibrate predict
SUITE ?= unit refusals pictures predict recordings live_replay
sanitize: all $(BUILD)/tests/lcm_listener
	$(MAKE) $(BUILD)-asan/tests/unit $(SANITIZED:%=$(BUILD)-asan/bin/pongeye-%) \
	    BUILD=$(BUILD)-asan SANITIZE=address,undefined OPTIMISE='-O1 -g1'
	ln -sf $(abspath $(BUILD))/bin/pongeye-simulate $(abspath $(BUILD))/bin/pongeye-bench $(BUILD)-asan/bin/
	ln -sf $(abspath $(BUILD))/tests/lcm_listener $(BUILD)-asan/tests/
	BUILD=$(BUILD)-asan ASAN_OPTIONS=detect_leaks=0 tests/run $(SUITE)

# Without calibration, which has no threads of its own and takes minutes.
tsan: deps
	$(MAKE) $(BUILD)-tsan/tests/unit BUILD=$(BUILD)-tsan SANITIZE=thread OPTIMISE='-O1 -g1'
	TSAN_OPTIONS=suppressions=tests/tsan.supp $(BUILD)-tsan/tests/unit --gtest_brief=1 \
	    --gtest_filter=-'*Calibrate*:*Refine*:*Corners*'

MINUTES ?= 10
soak: all
	BUILD=$(BUILD) tests/soak.sh $(MINUTES)

latency: all $(BUILD)/tests/latency_probe
	BUILD=$(BUILD) tests/latency.sh

loss: all
	BUILD=$(BUILD) tests/loss.sh

SOURCES := $(shell git ls-files '*.cpp' '*.hpp' '*.c' '*.h' 2>/dev/null)

format:
	clang-format -i $(SOURCES)

lint:
	clang-format --dry-run -Werror $(SOURCES)
	clang-tidy --quiet $(filter lib/%.cpp,$(SOURCES)) -- -std=c++17 -Ilib $(call cflags,$(PACKAGES_lib))

# What a variable of this file is: make print-LIB.
print-%:
	@echo $($*)

clean:
	rm -rf $(BUILD)

-include trigger/build.mk
-include tests/fuzz/build.mk
-include tests/arm/build.mk
