# Everything happens in .venv, which is made when it is needed. PYTHON=python3.13 chooses another Python.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
INSTALLED := $(VENV)/.installed
CODE := agentface tests examples docs/roles.py
PARALLEL := -n auto --maxprocesses 4 --dist worksteal
FRAMEWORKS := .venv-frameworks
COVERED := $(CURDIR)/out/coverage/data

# $(call debian,PACKAGES): install Debian packages when root, else print the command that does and stop
debian = if [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null; \
	then apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends $(1); \
	else echo "Debian packages are missing. Run this once:"; \
	echo "    sudo apt-get install --no-install-recommends $(1)"; exit 1; fi

# programs and libraries that the voices and tests need, and the Debian packages that bring them; as in tests/tools.py
TOOLS := xvfb-run:xvfb xauth:xauth xdotool:xdotool xprop:x11-utils oscsend:liblo-tools oscdump:liblo-tools node:nodejs npm:npm flite:flite chromium:chromium
LIBRARIES := libespeak-ng.so.1:libespeak-ng1
# what only the tests that take minutes need
SOAK_TOOLS := blender:blender
soak: TOOLS += $(SOAK_TOOLS)

.DEFAULT_GOAL := help
# the page of agentface/io/web: what npm brings and makes of it is not in the repository
PAGE := agentface/io/web/page
BUNDLE := $(PAGE)/dist/agentface.js

.PHONY: help demo test lint quick soak frameworks matrix docs build clean opengl voice tools warm page

help: ## this list
	@sed -n 's/^\([a-z]*\):.*## /make \1\t/p' $(MAKEFILE_LIST) | expand -t 14

demo: $(INSTALLED) opengl voice ## draw out/expressions.png, film out/demo.mp4 with an agent that talks OSC
	@$(BIN)/python examples/make_demo.py --out out
	@printf '\nThese commands are in %s.\n' $(BIN)

# dozens of tests start Python anew: it may keep what it compiled, even where the environment says otherwise
test quick soak frameworks matrix: export PYTHONDONTWRITEBYTECODE =
# goldens are software's pictures, also on a machine with a graphics card
test quick soak frameworks matrix: export LIBGL_ALWAYS_SOFTWARE = 1
# a skipped test is a failed one
test soak frameworks: export AGENTFACE_REQUIRE_TOOLS = 1
test: export COVERAGE_FILE = $(COVERED)

lint: $(INSTALLED)
	@$(BIN)/ruff check $(CODE)
	@$(BIN)/ruff format --check $(CODE)
	@$(BIN)/mypy

test: $(INSTALLED) opengl tools page lint warm ## ruff, mypy, all tests but the soaking ones, and how much of the code they ran
	@rm -rf $(dir $(COVERED)) && mkdir -p $(dir $(COVERED))
	@$(BIN)/coverage run -m pytest $(PARALLEL)
	@# a child whose disk was full, which is what some tests are about, has left a file that cannot be read
	@$(BIN)/coverage combine --quiet 2>/dev/null && rm -f $(COVERED).*
	@$(BIN)/coverage report

# who is not root goes without: the demo then says a recording
voice:
	@command -v flite >/dev/null || [ "$$(id -u)" != 0 ] || { $(call debian,flite); } || true

# every worker would compile the same kernels, and while it is traced
warm: $(INSTALLED)
	@$(BIN)/python -m tests.warm geometric & $(BIN)/python -m tests.warm tissue; status=$$?; wait; exit $$status

quick: $(INSTALLED) opengl lint ## a verdict within a minute: ruff, mypy and the tests that are not slow
	@$(BIN)/pytest -q $(PARALLEL) -m "not slow and not soak"

soak: $(INSTALLED) opengl tools page ## the tests that take minutes, and twice as many examples where hypothesis makes them
	@$(BIN)/pytest $(PARALLEL) -m soak --timeout 3600
	@$(BIN)/pytest $(PARALLEL) -m "hypothesis and not soak and not frameworks" --hypothesis-profile soak

matrix: $(INSTALLED) opengl tools page ## all tests on every Python that is found, and once with the lowest versions of the libraries
	@$(BIN)/python tests/matrix.py $(PARALLEL)

# about 850 MB; aiavatarkit without what it needs, torch among it: only its module of faces is loaded
$(FRAMEWORKS)/.installed: pyproject.toml
	$(PYTHON) -m venv $(FRAMEWORKS)
	$(FRAMEWORKS)/bin/python -m pip install --quiet --upgrade 'pip>=25.1'
	$(FRAMEWORKS)/bin/python -m pip install --quiet --editable '.[pipecat,livekit]' --group test
	$(FRAMEWORKS)/bin/python -m pip install --quiet --no-deps 'aiavatar>=0.9.2'
	@touch $@

# what warnings the frameworks give is their own affair
frameworks: $(FRAMEWORKS)/.installed opengl tools ## the adapters in Pipecat, LiveKit and aiavatarkit, in an environment of its own
	@$(FRAMEWORKS)/bin/python -m pytest -m frameworks -W default tests/agents/frameworks

docs: $(INSTALLED) ## the documents and the reference as a site, into out/site/
	@PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/zensical build --clean --strict
	@printf 'open out/site/index.html\n'

build: $(INSTALLED) page ## the wheel and the source archive, into dist/
	@$(BIN)/python -m build --no-isolation

page: $(BUNDLE) ## what a browser shows the face with; serve --web needs it

$(BUNDLE): $(PAGE)/package-lock.json $(PAGE)/build.mjs $(wildcard $(PAGE)/*.html $(PAGE)/src/*.js)
	@command -v npm >/dev/null || { $(call debian,nodejs npm); }
	@cd $(PAGE) && npm ci --no-audit --no-fund --ignore-scripts --loglevel=error && npm run --silent build

clean: ## remove everything that the other targets made
	rm -rf $(PAGE)/dist $(PAGE)/node_modules
	rm -rf $(VENV) $(FRAMEWORKS) out dist build .cache .pytest_cache .mypy_cache .ruff_cache .hypothesis .benchmarks
	find $(CODE) -name __pycache__ -prune -exec rm -rf {} +

# Debian's python3 comes without ensurepip; pip learned --group with 25.1
$(INSTALLED): pyproject.toml
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || { $(call debian,python3-venv); }
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade 'pip>=25.1'
	$(BIN)/python -m pip install --quiet --editable '.[window,speech,sound,mcp]' --group dev
	@touch $@

opengl: $(INSTALLED)
	@$(BIN)/python -c 'import ctypes; [ctypes.CDLL(f"lib{name}.so.1") for name in ("EGL", "GL")]' 2>/dev/null \
		|| { $(call debian,libegl1 libgl1); }

tools:
	@missing=; for tool in $(TOOLS); do command -v $${tool%%:*} >/dev/null || missing="$$missing $${tool#*:}"; done; \
	for library in $(LIBRARIES); do \
		$(PYTHON) -c "import ctypes; ctypes.CDLL('$${library%%:*}')" 2>/dev/null || missing="$$missing $${library#*:}"; \
	done; \
	if [ -n "$$missing" ]; then $(call debian,$$missing); fi
