# SPDX-License-Identifier: BSD-3-Clause
# A public header as Doxygen shall read it; each line stays where it is:
#   - the comment that follows the licence is that of the file, and what is indented there is code;
#   - what the namespace holds belongs to the group of its room;
#   - a comment is about all functions, or constants, that follow it without a blank line;
#   - copying, moving, destroying and what all classes of VTK have are left out where no comment tells of them;
#   - members of structs, and PCL's names of pointers, are listed where their names say enough and no comment more.
#   awk -f header_filter.awk HEADER
{ line[FNR] = $0 }

END {
  room = FILENAME
  sub(/(\/impl)?\/[^\/]*$/, "", room)
  if (!sub(/.*\/pcl_bsh\//, "", room)) room = "all" # the headers of all rooms
  gsub(/\//, "_", room)
  describe_file()
  leave_out_special_members()
  share_comments()
  list_members()
  fill_group()
  for (i = 1; i <= FNR; ++i) print line[i]
}

function describe_file(  i) {
  if (line[2] ~ /^\/\/\/ @class /) { # as VTK has it
    line[3] = "/// @ingroup " room " " substr(line[3], 5)
    return
  }
  line[1] = line[2] ~ /^\/\/ / ? "/// @file" : "/// @file that_has_no_comment" # which is none: an error
  for (i = 2; line[i] ~ /^\/\/( |$)/; ++i) line[i] = (line[i] ~ /^\/\/   / ? "///  " : "///") substr(line[i], 3)
}

function leave_out_special_members(  i, name) {
  for (i = 2; i <= FNR; ++i) {
    if (line[i - 1] ~ /^ *\/\/\/ / || line[i] ~ /\/\/\/</) continue
    name = line[i]
    sub(/^ */, "", name)
    sub(/\(.*/, "", name)
    if (name ~ /^(virtual )?~/ || name ~ / (operator=|PrintSelf|\* ?New)$|\* New$/ || index(line[i], " " name "(const " name "&") ||
        index(line[i], " " name "(" name "&&") || index(line[i], " " name "() = default;"))
      line[i] = ""
  }
}

function share_comments(  i, depth, code, kind, comment, told, finished) {
  for (i = 2; i <= FNR; ++i) {
    code = line[i]
    sub(/ *\/\/.*/, "", code)
    if (depth == 0 && line[i] ~ /^ *\/\/\/ /) { # a comment begins, or goes on
      if (told != "") comment = told = ""
      comment = comment substr(line[i], index(line[i], "///") + 3)
      continue
    }
    if (depth == 0 && code ~ /^ *$|^ *(public|protected|private):|^ *\}|^ *(struct|class|enum|namespace) /) {
      comment = told = ""
      continue
    }
    kind = code ~ /\(/ || code ~ /^ *template / ? "functions" : code ~ /constexpr|^#define/ ? "constants" : "others"
    if (depth == 0 && finished && comment != "" && kind == told && kind != "others" && line[i] !~ /\/\//) {
      sub(/ @param.*/, "", comment)
      line[i] = "/** " comment " */ " line[i]
    }
    if (depth == 0 && told == "") told = kind
    depth += gsub(/[{(]/, "&", code) - gsub(/[})]/, "&", code)
    finished = depth == 0 && code ~ /[;}]$|^#define/
  }
}

function list_members(  i, code, comment) {
  for (i = 2; i <= FNR; ++i) {
    if (line[i - 1] ~ /^ *\/\/\/ /) continue
    code = line[i]
    comment = "&#8203;"
    if (code ~ / *\/\/\/< /) { # which would be about the last of several
      comment = substr(code, index(code, "///<") + 5)
      sub(/ *\/\/\/<.*/, "", code)
      if (code !~ /, /) continue
    }
    if (code ~ /^  +(using (Indices|Cloud)?(Const)?(Ptr)? =|(static constexpr )?[A-Za-z_][A-Za-z_0-9:<>, *()&+]* [A-Za-z_0-9, =.]+( = .*|\{.*\})?;$)/ &&
        code !~ /^ *(return|friend|using [a-z]|else|throw) / && code !~ /\) (const|noexcept|override)/)
      line[i] = "/** " comment " */" code (code ~ /, / ? " ///< " comment : "")
  }
}

function fill_group(  i, opening) {
  for (i = 1; i <= FNR; ++i) {
    if (opening == "" && line[i] ~ /^namespace pcl_bsh.* \{/) {
      opening = line[i]
      sub(/ \{.*/, "", opening)
      line[i] = line[i] " /** @addtogroup " room " */ /** @{ */"
    } else if (opening != "" && index(line[i], "} // " opening) && line[i] !~ "// " opening ":") {
      line[i] = "/** @} */ " line[i]
      opening = ""
    }
  }
}
