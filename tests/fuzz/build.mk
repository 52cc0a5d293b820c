# Fuzz targets: any bytes into whatever reads bytes from outside; included by the top Makefile. Needs clang.
#   make fuzz                          20 s for each, from the inputs that are kept in tests/fuzz/corpus
#   make fuzz FUZZ_SECONDS=300         longer;  FUZZ="rig gige": only these
#   make fuzz-kept                     only those inputs, each once: what CI runs, since it is the same every time
# Kept are inputs that once failed, by the name of the fault, and those that reach what no other does, by the name of the
# function where they do. An input that fails is left in build-fuzz/: build-fuzz/fuzz/rig build-fuzz/rig-crash-... runs
# it again.

FUZZ_TARGETS := rig scene table points recording gige trigger firmware
FUZZ ?= $(FUZZ_TARGETS)
FUZZ_SECONDS ?= 20
# Where clang comes with libFuzzer already, the second does not exist or is not needed.
FUZZ_DEBIAN_PACKAGES := clang libclang-rt-dev
HAS_FUZZER := echo 'extern "C" int LLVMFuzzerTestOneInput(const char *, long) { return 0; }' | \
	clang++ -fsanitize=fuzzer -x c++ - -o /dev/null 2>/dev/null
FUZZ_BUILD := $(BUILD)-fuzz

# toml++ 3.3 calls unreachable what it reaches: its test for blanks, when it is asked of letters from U+00A1 to U+0499
# outside of quotes. What it goes on to do is still watched.
FUZZ_SANITIZE := address,undefined,fuzzer-no-link -fno-sanitize=unreachable

.PHONY: fuzz fuzz-kept fuzz-programs
fuzz: FUZZ_HOW = $(FUZZ_SECONDS)
fuzz-kept: FUZZ_HOW = kept
fuzz fuzz-kept: deps
	@$(HAS_FUZZER) || $(MAKE) --no-print-directory deps DEBIAN_PACKAGES="$(FUZZ_DEBIAN_PACKAGES)"
	@$(MAKE) --no-print-directory BUILD=$(FUZZ_BUILD) CC=clang CXX=clang++ OPTIMISE='-O1 -gline-tables-only' \
	    SANITIZE='$(FUZZ_SANITIZE)' fuzz-programs
	tests/fuzz/run $(FUZZ_BUILD) $(FUZZ_HOW) $(FUZZ)

fuzz-programs: $(FUZZ:%=$(BUILD)/fuzz/%)

# What each reads with.
FUZZ_OBJECTS_rig       := track/capture_settings calibrate/rig_edit
FUZZ_OBJECTS_scene     := $(addprefix simulate/,scene section text_file room texture sensor serve camera ball flight)
FUZZ_OBJECTS_table     :=
FUZZ_OBJECTS_points    := predict/points predict/follow
FUZZ_OBJECTS_recording := $(addprefix track/,replay event_log pair_message setup clock)
FUZZ_OBJECTS_gige      := $(addprefix simulate/gige/,control gvcp genicam power_on register_table registers stream)
FUZZ_OBJECTS_trigger   := usb_port clock_fit settings

# Of the library only what they need: all of it under sanitizers takes minutes to compile.
FUZZ_LIBRARY_rig       := document error rig settings
FUZZ_LIBRARY_recording := $(FUZZ_LIBRARY_rig)
FUZZ_LIBRARY_points    := error estimate flight halves noise outlook physics predict track trajectory $(FUZZ_LIBRARY_rig)
FUZZ_LIBS_recording    := lcm
FUZZ_LIBS_scene        := opencv4

fuzz_object = $(if $(filter trigger,$(1)),$(BUILD)/obj/trigger/$(2).o,$(BUILD)/obj/tools/$(2).o)
fuzz_objects = $(foreach object,$(FUZZ_OBJECTS_$(1)),$(call fuzz_object,$(1),$(object)))

define fuzz_program
$(BUILD)/fuzz/$(1): $(BUILD)/obj/tests/fuzz/$(1).o $(call fuzz_objects,$(1)) $(COMMON_OBJECTS) \
    $(sort $(FUZZ_LIBRARY_$(1):%=$(BUILD)/obj/lib/%.o))
	$$(begin)
	$$(Q)$$(CXX) $$(LDFLAGS) -fsanitize=fuzzer $$^ $$(call libs,$$(FUZZ_LIBS_$(1))) -pthread -o $$@
endef
$(foreach target,$(FUZZ_TARGETS),$(eval $(call fuzz_program,$(target))))

# They see the trigger's headers, and the firmware's sources a host's registers.
$(BUILD)/obj/tests/fuzz/trigger.o: override CPPFLAGS += -Itrigger
$(BUILD)/obj/tests/fuzz/firmware.o: override CPPFLAGS += -Itests/fuzz/avr
