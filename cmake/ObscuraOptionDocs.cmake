# Man page and completions: the program prints them from its tables of options.
# SPDX-License-Identifier: Apache-2.0
include(GNUInstallDirs)

set(option_docs)

# obscura_printed(KIND FILE FOLDER): `obscura print-docs KIND`, installed in share/FOLDER.
function(obscura_printed kind file folder)
  set(printed ${CMAKE_BINARY_DIR}/generated/${file})
  add_custom_command(OUTPUT ${printed}
    COMMAND obscura print-docs ${kind} --output ${printed}
    DEPENDS obscura
    COMMENT "Printing ${file}" VERBATIM)
  install(FILES ${printed} DESTINATION ${CMAKE_INSTALL_DATADIR}/${folder} COMPONENT program)
  list(APPEND option_docs ${printed})
  set(option_docs ${option_docs} PARENT_SCOPE)
endfunction()

file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/generated/bash)
obscura_printed(man obscura.1 man/man1)
obscura_printed(bash bash/obscura bash-completion/completions)
obscura_printed(zsh _obscura zsh/site-functions)
obscura_printed(fish obscura.fish fish/vendor_completions.d)
add_custom_target(option_docs ALL DEPENDS ${option_docs})
