# Run by cpack on the files that it is about to pack: what Debian has elsewhere, or compressed.
# SPDX-License-Identifier: Apache-2.0
set(share ${CPACK_TEMPORARY_DIRECTORY}${CPACK_PACKAGING_INSTALL_PREFIX}/share)
set(doc ${share}/doc/obscura)

# Where Debian's zsh looks for what packages bring; site-functions is not among its folders.
file(RENAME ${share}/zsh/site-functions ${share}/zsh/vendor-completions)

# Debian's changelog has a form of its own, which says only where ours is.
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${doc}/changelog "obscura (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * What has changed is in CHANGELOG.md.gz.

 -- ${CPACK_PACKAGE_CONTACT}  ${now}
")
execute_process(COMMAND gzip -9n ${doc}/changelog ${doc}/CHANGELOG.md ${share}/man/man1/obscura.1
  COMMAND_ERROR_IS_FATAL ANY)

# The licence's text is in every Debian system; the copyright says where.
file(REMOVE ${doc}/LICENSE)
file(COPY_FILE ${CMAKE_CURRENT_LIST_DIR}/debian_copyright ${doc}/copyright)
