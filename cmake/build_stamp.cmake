# Writes build_stamp.h with the commit that is being built, at every build, and only where it has changed.
# Called with -DSOURCE_DIR= -DOUTPUT= -DBUILD_TYPE= -DFLAGS=.
execute_process(COMMAND git rev-parse HEAD WORKING_DIRECTORY ${SOURCE_DIR}
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit "")
  set(dirty false)
else()
  execute_process(COMMAND git status --porcelain --untracked-files=no WORKING_DIRECTORY ${SOURCE_DIR}
    OUTPUT_VARIABLE changes ERROR_QUIET)
  if(changes STREQUAL "")
    set(dirty false)
  else()
    set(dirty true)
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [=[
#pragma once
namespace gradslc {
inline constexpr const char* k_git_commit = "@commit@";  // empty: not built from a git repository
inline constexpr bool k_git_dirty = @dirty@;
inline constexpr const char* k_build_type = "@BUILD_TYPE@";
inline constexpr const char* k_build_flags = "@FLAGS@";
}  // namespace gradslc
]=])
