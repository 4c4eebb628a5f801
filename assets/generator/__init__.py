# assets/generator/__init__.py - marks the folder as the package that makes the project's own scenes.
# SPDX-License-Identifier: Apache-2.0
