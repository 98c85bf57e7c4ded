# SPDX-License-Identifier: Apache-2.0
# versine_embed_texts(<target> <languages...>): the words of the reports, data/texts/<language>.toml, become part of
# the target, as report::built_in_texts.
function(versine_embed_texts target)
  set(cases "")
  foreach(language IN LISTS ARGN)
    set(file ${PROJECT_SOURCE_DIR}/data/texts/${language}.toml)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(READ ${file} content)
    # Compilers limit the length of one literal; neighbours are joined.
    string(REPLACE "\n[" ")texts\"\nR\"texts(\n[" content "${content}")
    string(APPEND cases "  if (language == \"${language}\") return R\"texts(${content})texts\";\n")
  endforeach()
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/texts/built_in_texts.cpp @ONLY CONTENT
"#include \"versine/report/texts.hpp\"

namespace versine::report {

std::string_view built_in_texts(std::string_view language) {
@cases@  return {};
}

}  // namespace versine::report
")
  target_sources(${target} PRIVATE ${PROJECT_BINARY_DIR}/texts/built_in_texts.cpp)
endfunction()
