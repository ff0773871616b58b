# Contact-free suspensions of rigid bodies in two-dimensional Stokes flow. `make` prints what there is to make.

CXX      ?= g++
CXXFLAGS ?= -O3
BUILD    ?= build
RESULTS  ?= results

# The folder of this file, from wherever it is read.
HERE := $(dir $(lastword $(MAKEFILE_LIST)))

# gnuplot reads UTF-8, and numbers have a point, wherever this runs.
export LC_ALL = C.UTF-8

# g++ 12 warns of uninitialised registers inside its own AVX-512 intrinsics (GCC bug 105593); clang still looks.
IS_CLANG := $(shell $(CXX) --version 2>/dev/null | grep -ci clang)
WARNINGS  = -Wall -Wextra -Wshadow $(if $(filter 0,$(IS_CLANG)),-Wno-uninitialized -Wno-maybe-uninitialized)
ARCH      = $(if $(PORTABLE),,-march=native)
# The number of threads must not change the order of Eigen's sums: it gets none.
FLAGS     = -std=c++20 $(WARNINGS) $(CXXFLAGS) $(ARCH) $(SANITIZERS) -pthread -DEIGEN_DONT_PARALLELIZE -Isrc -Iexperiments
LIBS      = -lfftw3 $(LDLIBS)

names        = $(basename $(notdir $(wildcard $(1))))
PROGRAMS    := simulate pack bench bench_fmm
EXPERIMENTS := $(call names,experiments/*.cpp)
# They read, check and write text.
TEXT        := bodies case case_keys case_limits checkpoint csv output_folder progress recorder run scales start_from text vtk
LIBRARY     := $(filter-out $(PROGRAMS) $(TEXT),$(call names,src/*.cpp)) $(TEXT)
TESTS       := $(filter-out fuzz_input,$(call names,tests/*.cpp))
FUZZER      := fuzz_input input_fuzzer
BINARIES    := $(addprefix $(BUILD)/,$(PROGRAMS) $(EXPERIMENTS))
OBJECTS     := $(patsubst %,$(BUILD)/%.o,$(LIBRARY) $(PROGRAMS) $(EXPERIMENTS) $(TESTS) fuzz_input)

.DELETE_ON_ERROR:
.SUFFIXES:
.PHONY: help deps deps-figures all objects test reproduce reproduce-all reproduce-quick verify figures movies paper bench \
        picture movie \
        sanitize sanitize-threads fuzz interruptions coverage \
        clean FORCE
.SECONDARY:

help:
	@echo 'make deps             install Eigen, FFTW and doctest where they are missing'
	@echo 'make test             build and run the tests; VERBOSE=1 prints what they measure'
	@echo 'make reproduce        run what decides each published number, and compare'
	@echo 'make reproduce-all    the same with all variants: other contact models, steps, nodes and starts; hours'
	@echo '  SEEDS=n             reproduce-all with n other random starts of each suspension between cylinders, 3 if not given'
	@echo 'make reproduce-quick  the coarse cases only'
	@echo 'make verify           compare the results that are there, without running anything'
	@echo 'make figures          draw the figures of the paper from the results (gnuplot)'
	@echo 'make paper            the report, with its figures, tables and numbers, from the results (gnuplot, LaTeX)'
	@echo 'make movies           moving pictures of three suspensions, minutes (gnuplot)'
	@echo 'make picture RUN=dir  the last state of a run of simulate, dir/picture.png (gnuplot); from another folder:'
	@echo '                      make -C here picture RUN=dir'
	@echo 'make movie RUN=dir    the run in motion, dir/movie.gif'
	@echo 'make deps-figures     install gnuplot and LaTeX where they are missing; nothing else needs them'
	@echo 'make all              build everything'
	@echo 'make objects          compile everything, tests too, and link nothing'
	@echo 'make bench            time the kernels, the multipole method and the solver'
	@echo 'make sanitize         the tests under the address and undefined-behaviour sanitizers'
	@echo 'make sanitize-threads  the same under the thread sanitizer'
	@echo 'make fuzz             read mutated input files, FUZZ="count=N seed=S"'
	@echo 'make interruptions    stop programs at random moments; 100 signals, or COUNT=n'
	@echo 'make coverage         lines and functions of src that the tests reach (gcov)'
	@echo 'make clean            remove $(BUILD) and $(RESULTS)'
	@echo
	@echo 'CXX=clang++  another compiler        PORTABLE=1   no -march=native'
	@echo 'BUILD=dir    another build folder    RESULTS=dir  another results folder'
	@echo 'MISSING=allow  figures and report of incomplete results'
	@echo '-j2          independent work side by side'

all: $(BINARIES) $(BUILD)/fuzz_input
objects: $(OBJECTS)

# --- dependencies ---------------------------------------------------------------------------------------
HEADERS  = eigen3/Eigen/Core fftw3.h doctest/doctest.h
missing  = for h in $(HEADERS); do echo "\#include <$$h>" | $(CXX) -std=c++20 -x c++ -fsyntax-only - 2>/dev/null || echo $$h; done
# $(call install,packages of apt,of dnf,of brew,of conda,modules)
install  = root=; [ "$$(id -u)" = 0 ] || root=sudo; \
           if command -v apt-get >/dev/null && { [ -z "$$root" ] || command -v $$root >/dev/null; }; then \
             $$root apt-get update -q && $$root env DEBIAN_FRONTEND=noninteractive \
               apt-get install -q -y --no-install-recommends $(1); \
           else \
             printf '%s\n' 'It takes apt-get, and root or sudo, to install it from here. Otherwise one of these lines does, where it may be typed:' \
               '  apt install $(1)' '  dnf install $(2)' '  brew install $(3)' \
               '  conda install -c conda-forge $(4)' '  module load $(5)  (the names of a site: module avail)' \
               'The compiler finds what is in another folder, DIR, after' \
               '  export CPLUS_INCLUDE_PATH=DIR/include LIBRARY_PATH=DIR/lib LD_LIBRARY_PATH=DIR/lib' >&2; \
             exit 1; \
           fi
deps:
	@if ! command -v $(CXX) >/dev/null || [ -n "$$($(missing))" ]; then \
	  echo 'Missing here:' $$(command -v $(CXX) >/dev/null || echo $(CXX)) $$($(missing)); \
	  $(call install,g++ libeigen3-dev libfftw3-dev doctest-dev,gcc-c++ eigen3-devel fftw-devel doctest-devel,$\
	    gcc eigen fftw doctest,gxx eigen fftw doctest,gcc eigen fftw doctest); \
	fi
deps-figures:
	@if ! command -v gnuplot >/dev/null || ! kpsewhich booktabs.sty lmodern.sty >/dev/null; then \
	  echo 'Missing here: gnuplot, or LaTeX with booktabs and lmodern'; \
	  $(call install,gnuplot-nox fonts-dejavu texlive-latex-recommended lmodern,$\
	    gnuplot dejavu-sans-fonts texlive-collection-latexrecommended texlive-lm,gnuplot texlive,gnuplot texlive-core,gnuplot texlive); \
	fi

# --- compilation ----------------------------------------------------------------------------------------
# The stamp holds the compiler and its flags: everything is rebuilt when they change.
STAMP := $(CXX) $(FLAGS) $(LIBS)
$(BUILD)/flags: FORCE | $(filter deps,$(MAKECMDGOALS))
	@mkdir -p $(BUILD)
	@echo '$(STAMP)' | cmp -s - $@ || echo '$(STAMP)' > $@

OBJECT   = -MMD -MP -c $< -o $@
LIGHT    = $(subst -O3,-O1,$(FLAGS))
DOCTEST  = -DDOCTEST_CONFIG_SUPER_FAST_ASSERTS

# Most of the time of most files goes into reading Eigen and the standard library. They are read once for each set of
# flags, and the compiler includes the result ahead of the files. ccache, which keeps objects, does without.
AHEAD    = algorithm array cmath complex filesystem fstream functional map memory numbers optional random string vector \
           eigen3/Eigen/Core
ifeq ($(findstring ccache,$(CXX)),)
ahead    = -include $(BUILD)/ahead/$(1).hpp
objects_with = $(patsubst %,$(BUILD)/%.o,$(2)): $(BUILD)/ahead/$(1).hpp.gch
$(eval $(call objects_with,full,$(filter-out packing $(TEXT),$(LIBRARY)) $(PROGRAMS)))
$(eval $(call objects_with,light,$(TEXT) $(EXPERIMENTS) $(FUZZER)))
$(eval $(call objects_with,tests,$(filter-out main test_gap $(FUZZER),$(TESTS))))
endif
$(BUILD)/ahead/%.hpp: $(BUILD)/flags
	@mkdir -p $(@D)
	@printf '#include <%s>\n' $(AHEAD) $(if $(filter tests,$*),doctest/doctest.h) > $@
$(BUILD)/ahead/full.hpp.gch: $(BUILD)/ahead/full.hpp
	$(CXX) $(FLAGS) -x c++-header $< -o $@
$(BUILD)/ahead/light.hpp.gch: $(BUILD)/ahead/light.hpp
	$(CXX) $(LIGHT) -x c++-header $< -o $@
$(BUILD)/ahead/tests.hpp.gch: $(BUILD)/ahead/tests.hpp
	$(CXX) $(LIGHT) $(DOCTEST) -x c++-header $< -o $@

$(OBJECTS): $(BUILD)/flags
$(BUILD)/%.o: src/%.cpp
	$(CXX) $(FLAGS) $(call ahead,full) $(OBJECT)
# Random starts have the same bits with every compiler: no product is fused with a sum.
$(BUILD)/packing.o: src/packing.cpp
	$(CXX) $(FLAGS) -ffp-contract=off $(OBJECT)
$(TEXT:%=$(BUILD)/%.o): $(BUILD)/%.o: src/%.cpp
	$(CXX) $(LIGHT) $(call ahead,light) $(OBJECT)
$(BUILD)/%.o: experiments/%.cpp
	$(CXX) $(LIGHT) $(call ahead,light) $(OBJECT)
$(BUILD)/%.o: tests/%.cpp
	$(CXX) $(LIGHT) $(DOCTEST) $(call ahead,tests) $(OBJECT)
# They are linked without doctest, too.
$(FUZZER:%=$(BUILD)/%.o): $(BUILD)/%.o: tests/%.cpp
	$(CXX) $(LIGHT) $(call ahead,light) $(OBJECT)
$(BUILD)/main.o: tests/main.cpp
	$(CXX) $(LIGHT) $(DOCTEST) $(OBJECT)
# It compares bits with what inline functions give in src.
$(BUILD)/test_gap.o: tests/test_gap.cpp
	$(CXX) $(FLAGS) $(DOCTEST) $(OBJECT)

# Of an inline function that several objects have, the linker takes the first: those with -O3 come first.
LINK   = $(CXX) $(FLAGS) $^ -o $@ $(LIBS)
SHARED = $(LIBRARY:%=$(BUILD)/%.o)
$(BUILD)/tests: $(SHARED) $(TESTS:%=$(BUILD)/%.o)
	$(LINK)
$(BUILD)/fuzz_input: $(SHARED) $(BUILD)/fuzz_input.o $(BUILD)/input_fuzzer.o
	$(LINK)
$(BINARIES): $(BUILD)/%: $(SHARED) $(BUILD)/%.o
	$(LINK)

-include $(wildcard $(BUILD)/*.d)

# --- tests ----------------------------------------------------------------------------------------------
test: $(BUILD)/tests $(BUILD)/simulate $(BUILD)/pack $(BUILD)/verify $(BUILD)/local_coupling $(BUILD)/fig6_injection
	@SIMULATE=$(BUILD)/simulate $(BUILD)/tests $(TESTS_RUN)

FUZZ = count=100000 seed=1
fuzz: $(BUILD)/fuzz_input
	@$(BUILD)/fuzz_input $(FUZZ)

interruptions: $(addprefix $(BUILD)/,simulate couette_run fig6_injection fig4_taylor_green)
	@tests/interruptions.sh "$(COUNT)" $(BUILD)

sanitize:
	$(MAKE) BUILD=$(BUILD)/sanitize CXXFLAGS='-O1 -g' PORTABLE=1 \
	  SANITIZERS='-fsanitize=address,undefined -fno-sanitize-recover=all' test

# TESTS_RUN='-sf=*test_fmm*' for some of the tests.
sanitize-threads:
	$(MAKE) BUILD=$(BUILD)/sanitize_threads CXXFLAGS='-O1 -g' PORTABLE=1 SANITIZERS='-fsanitize=thread' test

# Programs that are killed in a test leave no counts.
GCOV ?= gcov
coverage:
	@rm -f $(BUILD)/coverage/*.gcda
	-$(MAKE) BUILD=$(BUILD)/coverage CXXFLAGS='-O1 --coverage' PORTABLE=1 test
	@$(GCOV) -t -b -m -r $(BUILD)/coverage/*.o 2>/dev/null | awk -f tests/coverage.awk

# --- experiments: one process and one file a case -------------------------------------------------------
TABLE1_SEPARATIONS = 0 1 2 2.25 2.5 2.75 3
TABLE1_STEPS       = 0.04 0.02 0.01 0.005 0.0025
TABLE1_CASES       = $(foreach t,$(TABLE1_STEPS),$(foreach d,$(TABLE1_SEPARATIONS),delta$(d)h_dt$(t)))
TABLE1_VARIANTS    = $(foreach c,$(filter-out delta0h% delta1h%,$(TABLE1_CASES)),$(c)_stiv $(c)_stiv32)
FIG2_CASES         = $(foreach d,0 1 2 2.1 2.5 2.75 3,delta$(d)h) $(foreach d,2 2.1 2.5 3,published_$(d)h)
FIG3_CASES         = y0.75 y0.755 y0.76
LOCAL_CASES        = rate2_global rate2_local rate1_global rate1_local
CLOSE_CASES        = circle
NCP_CASES          = head_on_full shear_2h_full shear_3h_full
NCP_VARIANTS       = head_on_self shear_2h_self shear_3h_self
ADAPTIVE_RUNS      = fixed_dt0.04 adaptive_dt0.16 fixed_dt0.02 adaptive_dt0.08 fixed_dt0.01 adaptive_dt0.04
ADAPTIVE_CASES     = $(foreach r,$(ADAPTIVE_RUNS),$(r) $(r)_stiv $(r)_self)
VARIANT_CASES      = $(foreach c,global local,$(foreach m,full self,gap_$(c)_$(m) \
                       $(foreach v,32 128,$(foreach g,whole frozen,stiv$(v)_$(g)_$(c)_$(m)))))

# Longest first, so that two processes end together.
FIG4_STEPS         = 0.00625 0.0125 0.025
FIG4_CASES         = $(FIG4_STEPS:%=dt%)
FIG4_VARIANTS      = $(foreach t,$(FIG4_STEPS),dt$(t)_stiv dt$(t)_plain) points64 tolerance1e-8 adaptive_dt0.1
TG_CASES           = cold free_points32_dt0.0025 local_contact_dt1e-8 points
TG_CONTINUED       = global_full_dt0.01 global_self_dt0.01 local_start_dt0.025 local_start_dt0.0025 \
                       $(foreach t,1e-2 1e-4 1e-6 1e-8,local_contact_dt$(t))
TG_FREE            = $(foreach p,32 64,$(foreach t,0.0025 0.01 0.025,free_points$(p)_dt$(t))) \
                       $(foreach t,0.0025 0.01 0.025,free_points32_dt$(t)_near)
TG_ITERATIONS      = $(foreach k,none block pair,$(foreach t,1e-6 1e-8,extrapolated_$(k)_$(t)))
TG_VARIANTS        = $(filter-out $(TG_CASES),$(TG_FREE) $(TG_ITERATIONS) $(TG_CONTINUED))
INJECTION_CASES    = paper undisturbed
INJECTION_ALL_CASES = paper_stiv paper_delta0.2h paper_delta0.3h paper_dt0.04 paper_dt0.02 paper_wall256 quick

# Section 4.4: the paper's start of each suspension, longest first, and SEEDS other ones.
SEEDS              ?= 3
COUETTE            = phi15_lambda3 phi10_lambda6 phi5_lambda6 phi10_lambda3 phi15_lambda1 phi10_lambda1 phi5_lambda3 phi5_lambda1
COUETTE_CASES      = $(COUETTE:%=%_paper)
COUETTE_ALL_CASES  = $(foreach k,$(shell seq $(SEEDS)),$(COUETTE:%=%_seed$(k))) \
                     $(foreach v,points64 halfstep stiv,phi5_lambda3_paper_$(v)) \
                     $(foreach v,halfstep quarterstep,phi10_lambda1_paper_$(v))
COUETTE_STEPS      = $(COUETTE:%=%_paper_ab2_250) $(COUETTE:%=%_paper_ab2_500)
TG_ORDER_CASES     = $(foreach t,0.025 0.0125 0.00625 0.003125,euler_dt$(t)) $(foreach t,0.1 0.05 0.025,ab2_dt$(t)) \
                       $(foreach t,0.2 0.1 0.05 0.0125,rk3_dt$(t))
REVERSAL_CASES     = euler ab2 rk3 midpoint
RESOLVED_OBJECTS   = $(foreach t,0.04 0.01,$(foreach d,0 2 3,table1_delta$(d)h_dt$(t))) taylor_green injection couette
RESOLVED_CASES     = $(foreach o,$(RESOLVED_OBJECTS),$(o)_points32 $(o)_accuracy1e-6)
COUETTE_TABLES     = table2_order_parameter table3_effective_viscosity fig9_order_parameter fig10_effective_viscosity

# $(call experiment,name,cases,quick cases,variants): `name` makes its cases, which decide the published numbers, and then
# its tables; `name-all` makes the variants, too. An experiment of variants alone is no part of `reproduce`.
# How many cases of the target are there already. How long the others take is not said: between a second and an hour each.
cases_done = $(foreach t,$(filter reproduce reproduce-all reproduce-quick,$(MAKECMDGOALS)), \
               "($$(ls $($(t)_files) 2>/dev/null | wc -l) of $(words $($(t)_files)) cases of $(t) are done)")
define experiment
.PHONY: $(1) $(1)-quick $(1)-all
$(RESULTS)/$(1)/%.csv: $(BUILD)/$(1)
	@echo $(1) $$* $$(cases_done)
	@$(BUILD)/$(1) case=$$* results=$(RESULTS)
$(1): $(BUILD)/$(1) $$(patsubst %,$(RESULTS)/$(1)/%.csv,$(or $(2),$(4)))
	@$(BUILD)/$(1) collect results=$(RESULTS)
$(1)-quick: $(BUILD)/$(1) $$(patsubst %,$(RESULTS)/$(1)/%.csv,$(3))
	@$(BUILD)/$(1) collect results=$(RESULTS)
$(1)-all: $(BUILD)/$(1) $$(patsubst %,$(RESULTS)/$(1)/%.csv,$(2) $(4))
	@$(BUILD)/$(1) collect results=$(RESULTS)
reproduce_files       += $(2:%=$(RESULTS)/$(1)/%.csv)
reproduce-quick_files += $(3:%=$(RESULTS)/$(1)/%.csv)
reproduce-all_files   += $$(addsuffix .csv,$$(addprefix $(RESULTS)/$(1)/,$(2) $(4)))
$(if $(2)$(3)$(if $(4),,tables),reproduce: $(1)
reproduce-quick: $(1)-quick)
reproduce-all: $(1)-all
endef
$(eval $(call experiment,table1_reversibility,$(TABLE1_CASES),$(foreach t,0.04 0.02 0.01,$(filter %_dt$(t),$(TABLE1_CASES))),$(TABLE1_VARIANTS)))
$(eval $(call experiment,fig2_shear_separation,$(FIG2_CASES),$(FIG2_CASES)))
$(eval $(call experiment,fig3_pathlines,$(FIG3_CASES),$(FIG3_CASES)))
$(eval $(call experiment,local_coupling,$(LOCAL_CASES),$(LOCAL_CASES)))
$(eval $(call experiment,contact_variants,,,$(VARIANT_CASES)))
$(eval $(call experiment,ncp_iterations,$(NCP_CASES),$(NCP_CASES),$(NCP_VARIANTS)))
$(eval $(call experiment,close_evaluation,$(CLOSE_CASES),$(CLOSE_CASES)))
$(eval $(call experiment,fig4_taylor_green,$(FIG4_CASES),quick,$(FIG4_VARIANTS)))
$(eval $(call experiment,taylor_green_claims,$(TG_CASES),points,$(TG_VARIANTS)))
$(eval $(call experiment,couette_run,$(COUETTE_CASES),phi5_lambda3_paper_quick,$(COUETTE_ALL_CASES) $(COUETTE_STEPS)))
$(eval $(call experiment,reversal,$(REVERSAL_CASES),$(REVERSAL_CASES)))
$(eval $(call experiment,taylor_green_order,,,$(TG_ORDER_CASES)))
$(eval $(call experiment,jeffery_steps,$(REVERSAL_CASES),$(REVERSAL_CASES)))
$(eval $(call experiment,fig8_initial_configurations,$(COUETTE),$(COUETTE)))
$(foreach t,$(COUETTE_TABLES),$(eval $(call experiment,$(t),$(if $(filter fig9%,$(t)),orbit),$(if $(filter fig9%,$(t)),orbit))))
.PHONY: couette_step_limit
couette_step_limit: $(BUILD)/couette_step_limit $(COUETTE_CASES:%=$(RESULTS)/couette_run/%.csv) $(COUETTE_STEPS:%=$(RESULTS)/couette_run/%.csv)
	@$(BUILD)/couette_step_limit collect results=$(RESULTS)
reproduce-all: couette_step_limit
$(COUETTE_TABLES): couette_run
$(COUETTE_TABLES:%=%-all): couette_run-all
$(eval $(call experiment,fig6_injection,$(INJECTION_CASES),quick undisturbed,$(INJECTION_ALL_CASES)))
$(eval $(call experiment,fig7_shear_stress,paper,))
# Figure 7 is computed from the positions of Figure 6.
$(RESULTS)/fig7_shear_stress/paper.csv: $(RESULTS)/fig6_injection/paper.csv
$(eval $(call experiment,resolved,,,$(RESOLVED_CASES)))
$(eval $(call experiment,adaptive_steps,,,$(ADAPTIVE_CASES)))

couette_cases:  # their names, for experiments/submit_couette.sh
	@printf '%s\n' $(COUETTE_CASES) $(COUETTE_ALL_CASES)

# simulate is what a reader tries next.
reproduce reproduce-quick: $(BUILD)/simulate
reproduce reproduce-all verify: $(BUILD)/verify
	@$(BUILD)/verify results=$(RESULTS) readme=README.md
reproduce-quick: $(BUILD)/verify
	@$(BUILD)/verify results=$(RESULTS) missing=allow rows=differing

# --- figures and report, from the results that are there --------------------------------------------------
figures:
	@$(MAKE) -k --no-print-directory -f paper/Makefile figures
paper: $(BUILD)/verify $(BUILD)/report $(RESULTS)/bench/bench.csv
	@rm -f $(RESULTS)/report/report.pdf
	@$(MAKE) -k --no-print-directory -f paper/Makefile paper
movies: $(BUILD)/simulate
	@$(MAKE) -k --no-print-directory -f paper/Makefile movies

# --- pictures of any run ----------------------------------------------------------------------------------
# A relative folder begins where make was called, also with -C.
RUN_FOLDER = $(firstword $(wildcard $(RUN)) $(if $(RUN),$(wildcard $(PWD)/$(RUN))))
picture: DRAWN = kind='png'; output_file='$(RUN_FOLDER)/picture.png'; frames=1
movie: DRAWN = kind='gif'; output_file='$(RUN_FOLDER)/movie.gif'; frames=300
picture movie:
	@[ -n '$(RUN)' ] || { echo 'make $@ RUN=folder: the output folder of a run of simulate' >&2; exit 1; }
	@[ -f '$(RUN_FOLDER)/trajectory.csv' ] && [ -f '$(RUN_FOLDER)/bodies.csv' ] || \
	  { echo '$(RUN): there are no trajectory.csv and bodies.csv of a run of simulate' >&2; exit 1; }
	@command -v gnuplot >/dev/null || { echo 'gnuplot is missing: make deps-figures' >&2; exit 1; }
	@gnuplot -e "here='$(HERE)paper/figures/'; folder='$(RUN_FOLDER)'; $(DRAWN)" $(HERE)paper/figures/run.gp
	@echo '$(RUN_FOLDER)/$(if $(filter movie,$@),movie.gif,picture.png)'

# --- timings: nothing of them is compared -----------------------------------------------------------------
$(RESULTS)/bench/bench.csv: $(BUILD)/bench
	@mkdir -p $(@D)
	@{ $(BUILD)/bench threads=1; $(BUILD)/bench | tail -n +2; } > $@
# points:tolerance:distribution:threads
FMM_RUNS = $(foreach k,$(sort 1 $(shell nproc)),$(foreach n,1000 2000 4000 10000 100000 1000000,$(foreach d,uniform discs annulus, \
             $(n):1e-9:$(d):$(k))) $(foreach t,1e-3 1e-6 1e-12,100000:$(t):uniform:$(k)))
$(RESULTS)/bench/fmm.csv: $(BUILD)/bench_fmm
	@mkdir -p $(@D)
	@for run in $(FMM_RUNS); do echo $$run | { IFS=: read -r n t d k; \
	   $(BUILD)/bench_fmm points=$$n tolerance=$$t distribution=$$d threads=$$k | sed "1 s/^/distribution,/; 2 s/^/$$d,/"; }; \
	 done | awk 'NR == 1 || !/^distribution/' > $@
bench:
	@rm -f $(RESULTS)/bench/bench.csv $(RESULTS)/bench/fmm.csv
	@$(MAKE) --no-print-directory $(RESULTS)/bench/bench.csv $(RESULTS)/bench/fmm.csv
	@cat $(RESULTS)/bench/bench.csv $(RESULTS)/bench/fmm.csv

clean:
	rm -rf $(BUILD) $(RESULTS)
