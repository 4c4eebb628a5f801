# assets/generator/__init__.py - the package that makes the project's own scenes.
# SPDX-License-Identifier: Apache-2.0
