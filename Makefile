# Every target sets up what it needs: .venv, once, and again when setup.py changes.
SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
# where the recordings of a real grasper lie, if they do: make demo GRASPER=FILE.npz
GRASPER ?= $(firstword $(wildcard ../shared/recordings/davinci_grasper/*.npz))
PY := .venv/bin/python
READY := .venv/.ready
EXECUTABLES := tendon simulator estimator trajectory recorder monitor

# Messages stay on this machine, and a field of the wrong type is an error instead of garbage.
export ROS_AUTOMATIC_DISCOVERY_RANGE ?= LOCALHOST
export ROS_PYTHON_CHECK_FIELDS := 1
# Set where make itself was started by a Python with the ROS wheels; ours has its own libraries.
unexport _ROS_WHEELS_BOOTSTRAP_COMPLETE

.PHONY: help setup test lint demo bench colcon lowest clean

help:  ## say what there is
	@sed -n 's/^\([a-z-]*\):.*## /  make \1\t/p' Makefile | expand -t 18

$(READY): setup.py setup.cfg scripts/setup_venv
	@scripts/setup_venv
	@touch $@

setup: $(READY)  ## make .venv and install everything into it

lint: $(READY)  ## style, types and import walls
	@echo '== ruff'; $(PY) -m ruff check .
	@$(PY) -m ruff format --check .
	@echo '== mypy'; $(PY) -m mypy
	@echo '== import-linter'; .venv/bin/lint-imports --no-logo

test: lint  ## lint, then the tests; ARGS='-k bags' goes to pytest
	@echo '== pytest'; $(PY) -m pytest -n auto --maxprocesses 4 --dist worksteal $(ARGS)

demo: $(READY)  ## the paper's experiment, live, into out/demo
	@.venv/bin/tendon demo --out out/demo $(if $(GRASPER),--grasper $(GRASPER))

bench: $(READY)  ## the kernel's speed against C, scipy and others
	@$(PY) -m bench $(ARGS)

colcon: $(READY)  ## build into install/ with colcon and start what ros2 run starts
	@rm -rf build install log
	@$(PY) -m colcon build --base-paths . --packages-select tendon_ros
	@set +u; . install/setup.bash; cd install; \
	for name in $(EXECUTABLES); do \
	    timeout 60 tendon_ros/lib/tendon_ros/$$name --help >/dev/null; echo "lib/tendon_ros/$$name runs"; \
	done

lowest: $(READY)  ## the tests with the oldest versions that setup.py allows
	@rm -rf build/lowest; $(PY) -m venv build/lowest
	@grep -oE "'[a-z0-9-]+>=[0-9.]+'" setup.py | tr -d "'" | sed 's/>=/==/' >build/lowest/oldest.txt
	@build/lowest/bin/python -m pip install --quiet --disable-pip-version-check \
	    --constraint build/lowest/oldest.txt --editable '.[fast,ros,test]'
	@build/lowest/bin/python -m pytest $(ARGS)

clean:  ## remove what was built, .venv too
	rm -rf .venv build install log dist *.egg-info .mypy_cache .ruff_cache .pytest_cache \
	    .hypothesis .import_linter_cache
	find . -name __pycache__ -prune -exec rm -rf {} +
