# Everything happens in .venv, which is made when it is needed. PYTHON=python3.13 chooses another Python.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
INSTALLED := $(VENV)/.installed
CODE := agentface tests examples

# $(call debian,PACKAGES): install Debian packages when root, else print the command that does and stop
debian = if [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null; \
	then apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends $(1); \
	else echo "Debian packages are missing. Run this once:"; \
	echo "    sudo apt-get install --no-install-recommends $(1)"; exit 1; fi

# programs that only tests need, and the Debian packages that bring them; as in tests/tools.py
TOOLS := xvfb-run:xvfb xauth:xauth xdotool:xdotool xprop:x11-utils oscsend:liblo-tools oscdump:liblo-tools node:nodejs npm:npm

.DEFAULT_GOAL := help
.PHONY: help demo test build clean opengl tools

help: ## this list
	@sed -n 's/^\([a-z]*\):.*## /make \1\t/p' $(MAKEFILE_LIST) | expand -t 14

demo: $(INSTALLED) opengl ## draw out/expressions.png, film out/demo.mp4 with an agent that talks OSC
	@$(BIN)/python examples/make_demo.py --out out
	@printf '\nThese commands are in %s.\n' $(BIN)

# dozens of tests start Python anew: it may keep what it compiled, even where the environment says otherwise
test: export PYTHONDONTWRITEBYTECODE =
# a skipped test is a failed one
test: export AGENTFACE_REQUIRE_TOOLS = 1
# goldens are software's pictures, also on a machine with a graphics card
test: export LIBGL_ALWAYS_SOFTWARE = 1
test: $(INSTALLED) opengl tools ## ruff, mypy and all tests
	@$(BIN)/ruff check $(CODE)
	@$(BIN)/ruff format --check $(CODE)
	@$(BIN)/mypy
	@$(BIN)/pytest -n auto --maxprocesses 4 --dist worksteal

build: $(INSTALLED) ## the wheel and the source archive, into dist/
	@$(BIN)/python -m build --no-isolation

clean: ## remove everything that the other targets made
	rm -rf $(VENV) out dist build .pytest_cache .mypy_cache .ruff_cache .hypothesis .benchmarks
	find $(CODE) -name __pycache__ -prune -exec rm -rf {} +

# Debian's python3 comes without ensurepip; pip learned --group with 25.1
$(INSTALLED): pyproject.toml
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || { $(call debian,python3-venv); }
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade 'pip>=25.1'
	$(BIN)/python -m pip install --quiet --editable '.[window]' --group dev
	@touch $@

opengl: $(INSTALLED)
	@$(BIN)/python -c 'import ctypes; [ctypes.CDLL(f"lib{name}.so.1") for name in ("EGL", "GL")]' 2>/dev/null \
		|| { $(call debian,libegl1 libgl1); }

tools:
	@missing=; for tool in $(TOOLS); do command -v $${tool%%:*} >/dev/null || missing="$$missing $${tool#*:}"; done; \
	if [ -n "$$missing" ]; then $(call debian,$$missing); fi
