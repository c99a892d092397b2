(* SPDX-License-Identifier: Apache-2.0 *)
(* Reads meshes, poses and certificates into the types of the proved checker. Nothing here is proved. *)
module Big = Z
open Checked
module Z = Big (* not the unused functions that Coq extracts under this name *)

exception Unreadable of string

let unreadable format = Printf.ksprintf (fun text -> raise (Unreadable text)) format

let read_file path =
  try
    let channel = if path = "-" then stdin else open_in_bin path in
    set_binary_mode_in channel true;
    let buffer = Buffer.create 65536 in
    (try while true do Buffer.add_channel buffer channel 65536 done with End_of_file -> ());
    if path <> "-" then close_in channel;
    Buffer.contents buffer
  with Sys_error what -> unreadable "%s: the file cannot be read (%s)" path what

(* Numbers. *)

let exact value =
  if value = 0.0 then { mantissa = Z.zero; exponent = Z.zero }
  else
    let fraction, e = Float.frexp value in
    let m = Z.of_float (Float.ldexp fraction 53) in
    let zeros = Z.trailing_zeros m in
    { mantissa = Z.shift_right m zeros; exponent = Z.of_int (e - 53 + zeros) }

(* The double again, in the fewest digits that are read as the same. *)
let to_text n =
  let value = Float.ldexp (Z.to_float n.mantissa) (Z.to_int n.exponent) in
  let rec shortest digits =
    let text = Printf.sprintf "%.*g" digits value in
    if digits >= 17 || float_of_string text = value then text else shortest (digits + 1) in
  shortest 1

(* A decimal number as the nearest double, by the C library's strtod. *)
let decimal word =
  let size = String.length word in
  let digits from = let i = ref from in while !i < size && word.[!i] >= '0' && word.[!i] <= '9' do incr i done; !i in
  let start = if size > 0 && (word.[0] = '-' || word.[0] = '+') then 1 else 0 in
  let whole = digits start in
  let fraction = if whole < size && word.[whole] = '.' then digits (whole + 1) else whole in
  let any = whole > start || fraction > whole + 1 in
  let last =
    if fraction < size && (word.[fraction] = 'e' || word.[fraction] = 'E') then
      let sign = fraction + 1 in
      let from = if sign < size && (word.[sign] = '-' || word.[sign] = '+') then sign + 1 else sign in
      let last = digits from in
      if last = from then -1 else last
    else fraction in
  if not any || last <> size then unreadable "'%s' is not a number" word;
  let value = float_of_string word in
  if not (Float.is_finite value) then unreadable "'%s' is beyond the range of doubles" word;
  value

let count word =
  if word = "" || String.length word > 15 || not (String.for_all (fun c -> c >= '0' && c <= '9') word)
  then unreadable "'%s' is not a count" word
  else int_of_string word

(* Meshes: doubles, for the hash, and the faces of the checker. *)

type corner = { doubles : float array; numbers : number triple }
type mesh_read = { faces : face list; hash : string }

let corner doubles =
  { doubles; numbers = { x = exact doubles.(0); y = exact doubles.(1); z0 = exact doubles.(2) } }

let hash_words words =
  let step h word =
    let h = Int64.mul (Int64.logxor h word) 0x100000001b3L in
    Int64.logxor h (Int64.shift_right_logical h 32) in
  Printf.sprintf "%016Lx" (List.fold_left step 0xcbf29ce484222325L words)

let bits value = Int64.bits_of_float (value +. 0.0)

(* outlines: of each face its number in the file and its vertices *)
let to_mesh outlines =
  let words (number, corners) =
    Int64.add (Int64.of_int number) (Int64.shift_left (Int64.of_int (List.length corners)) 32)
    :: List.concat_map (fun c -> List.map bits (Array.to_list c.doubles)) corners in
  { faces = List.rev (List.rev_map (fun (number, corners) ->
        { number_in_file = Z.of_int number; vertices = List.map (fun c -> c.numbers) corners }) outlines);
    hash = hash_words (List.concat (List.rev (List.rev_map words outlines))) }

let words_of_lines text =
  let text = String.map (fun c -> if c = '\r' then '\n' else c) text in
  let words line =
    let line = match String.index_opt line '#' with Some i -> String.sub line 0 i | None -> line in
    let line = String.map (fun c -> if c = '\t' || c = '\011' || c = '\012' then ' ' else c) line in
    List.filter (fun word -> word <> "") (String.split_on_char ' ' line) in
  List.filter (fun words -> words <> [])
    (List.rev (List.rev_map words (String.split_on_char '\n' text)))

let outline points number indices =
  let corners = List.map (fun i ->
      if i < 0 || i >= Array.length points then unreadable "face %d: a vertex that is not there" number else points.(i)) indices in
  match List.length corners with
  | 3 | 4 -> (number, corners)
  | n -> unreadable "face %d has %d corners; write triangles and quads" number n

let rec take n list = if n = 0 then [] else match list with [] -> unreadable "a line is too short" | a :: rest -> a :: take (n - 1) rest

let point words = corner (Array.of_list (List.map decimal (take 3 words)))

let read_off lines =
  let header, rest = match lines with
    | [ "OFF" ] :: (counts :: rest) -> (counts, rest)
    | ("OFF" :: (_ :: _ as counts)) :: rest -> (counts, rest)
    | _ -> unreadable "no OFF file with a line for each vertex and face" in
  let vertices, faces = match header with v :: f :: _ -> (count v, count f) | _ -> unreadable "no counts" in
  let rec split n taken lines =
    if n = 0 then (List.rev taken, lines)
    else match lines with [] -> unreadable "the file ends early" | line :: rest -> split (n - 1) (line :: taken) rest in
  let vertex_lines, rest = split vertices [] rest in
  let face_lines, rest = split faces [] rest in
  if rest <> [] then unreadable "the file continues after the last face";
  let points = Array.of_list (List.rev (List.rev_map point vertex_lines)) in
  let face number line =
    let n = count (List.hd line) in
    let indices = List.map count (take n (List.tl line)) in
    if n < 3 then None else Some (outline points number indices) in
  List.filter_map Fun.id (List.mapi face face_lines)

let obj_words = [ "vt"; "vn"; "vp"; "g"; "o"; "s"; "mg"; "l"; "p"; "usemtl"; "mtllib"; "usemap"; "end" ]

let read_obj lines =
  let points = ref [] and faces = ref [] and known = ref 0 and number = ref 0 in
  let line = function
    | "v" :: words ->
      List.iter (fun w -> ignore (decimal w)) words;
      if List.length words = 4 && decimal (List.nth words 3) <> 1.0 then unreadable "a vertex has a weight other than 1";
      points := point words :: !points; incr known
    | ("f" | "fo") :: corners ->
      let index text =
        let text = match String.index_opt text '/' with Some i -> String.sub text 0 i | None -> text in
        match int_of_string_opt text with
        | Some i when i > 0 -> i - 1
        | Some i when i < 0 -> !known + i
        | _ -> unreadable "'%s' is not a vertex" text in
      faces := (!number, List.map index corners) :: !faces; incr number
    | word :: _ when List.mem word obj_words -> ()
    | word :: _ -> unreadable "'%s' is not read" word
    | [] -> () in
  List.iter line lines;
  let points = Array.of_list (List.rev !points) in
  List.rev_map (fun (number, indices) -> outline points number indices) !faces

let read_binary_stl text =
  if String.length text < 84 then unreadable "the file ends within the header of a binary STL";
  let announced = Int32.to_int (String.get_int32_le text 80) land 0xffffffff in
  if String.length text <> 84 + 50 * announced then unreadable "no binary STL of the size that its header announces";
  let number triangle k =
    let value = Int32.float_of_bits (String.get_int32_le text (84 + 50 * triangle + 12 + 4 * k)) in
    if Float.is_finite value then value else unreadable "face %d: a vertex is not finite" triangle in
  List.init announced (fun t ->
      (t, List.init 3 (fun v -> corner (Array.init 3 (fun k -> number t (3 * v + k))))))

let read_outlines path text =
  let text = if String.length text >= 3 && String.sub text 0 3 = "\xef\xbb\xbf" then String.sub text 3 (String.length text - 3) else text in
  match String.lowercase_ascii (Filename.extension path) with
  | ".stl" -> read_binary_stl text
  | ".obj" -> read_obj (words_of_lines text)
  | ".off" -> read_off (words_of_lines text)
  | _ -> (match words_of_lines text with
      | (word :: _) :: _ as lines when word = "OFF" -> read_off lines
      | lines -> read_obj lines)

let to_single c = corner (Array.map (fun v ->
    let single = Int32.float_of_bits (Int32.bits_of_float v) in
    if Float.is_finite single then single else unreadable "a coordinate is beyond the range of single precision") c.doubles)

let read_mesh ?(single = false) path =
  let text = read_file path in
  try
    let outlines = read_outlines path text in
    let outlines = if single then List.map (fun (n, corners) -> (n, List.map to_single corners)) outlines else outlines in
    if outlines = [] then unreadable "the file has no faces";
    to_mesh outlines
  with Unreadable what -> unreadable "%s: %s" path what

(* Poses: the twelve doubles of [R | t], row by row. *)

let identity = [| 1.; 0.; 0.; 0.; 0.; 1.; 0.; 0.; 0.; 0.; 1.; 0. |]

let to_pose p : pose =
  let row r = { entries = { x = exact p.(r); y = exact p.(r + 1); z0 = exact p.(r + 2) }; shift = exact p.(r + 3) } in
  { x = row 0; y = row 4; z0 = row 8 }

let hash_poses p q = hash_words (List.map bits (Array.to_list p @ Array.to_list q))

let numbers_of text = List.map (fun word -> decimal (String.trim word)) (String.split_on_char ',' text)

let of_translation x y z = [| 1.; 0.; 0.; x; 0.; 1.; 0.; y; 0.; 0.; 1.; z |]

let pose_of_option text = match numbers_of text with
  | [ x; y; z ] | [ x; y; z; 0.; 0.; 0. ] -> of_translation x y z
  | _ -> unreadable "--pose: write tx,ty,tz; turn by --pose-matrix, whose numbers are exact"

let pose_of_matrix text = match numbers_of text with
  | n when List.length n = 12 -> Array.of_list n
  | n when List.length n = 16 && List.filteri (fun i _ -> i >= 12) n = [ 0.; 0.; 0.; 1. ] -> Array.of_list (take 12 n)
  | _ -> unreadable "--pose-matrix: write the twelve numbers of the 3x4 matrix row by row, or the sixteen of a 4x4 matrix"

let pose_columns = [ "r00"; "r01"; "r02"; "tx"; "r10"; "r11"; "r12"; "ty"; "r20"; "r21"; "r22"; "tz" ]

(* CSV with columns tx, ty, tz and, for a rotation, r00 to r22; other columns are ignored unless they are of a rotation. *)
let poses_of_csv path =
  let lines = String.split_on_char '\n' (String.map (fun c -> if c = '\r' then '\n' else c) (read_file path)) in
  let rows = List.filter (fun line -> String.trim line <> "") lines in
  let cells line = Array.of_list (List.map String.trim (String.split_on_char ',' line)) in
  match rows with
  | [] -> unreadable "%s: the file is empty" path
  | header :: rows ->
    let names = Array.to_list (cells header) in
    let place name = let rec go i = function [] -> None | n :: rest -> if n = name then Some i else go (i + 1) rest in go 0 names in
    let matrix = place "r00" <> None in
    if not matrix && List.exists (fun n -> place n <> None) [ "rx"; "ry"; "rz"; "roll"; "pitch"; "yaw"; "qx"; "qy"; "qz"; "qw" ]
    then unreadable "%s: write rotations as columns r00 to r22, whose numbers are exact" path;
    let wanted = List.filter (fun n -> matrix || n.[0] = 't') pose_columns in
    let places = List.map (fun n -> match place n with Some i -> (n, i) | None -> unreadable "%s: column %s is missing" path n) wanted in
    List.map (fun row ->
        let row = cells row in
        if Array.length row <> List.length names then unreadable "%s: a row has another number of fields than the header" path;
        Array.of_list (List.mapi (fun k n -> match List.assoc_opt n places with
            | Some i -> decimal row.(i)
            | None -> identity.(k)) pose_columns)) rows

(* Certificates. *)

(* trees: the hashes of those that are cited; fault: why the certificate is refused, though it can be read *)
type certificate_read =
  { certificate : certificate; mesh_hashes : string * string; poses_hash : string; trees : (string * string) option;
    fault : string option }

let malformed what = raise (Json.Malformed what)
let get fields key = match Json.find key fields with Some value -> value | None -> malformed ("no key " ^ key)
let whole = function
  | Json.Whole n when Z.sign n >= 0 && Z.numbits n <= 32 -> n
  | _ -> malformed "not a number below 2^32"
let list = function Json.List l -> l | _ -> malformed "not a list"
let map f l = List.rev (List.rev_map f l)

let integer = function
  | Json.String text ->
    let size = String.length text in
    let sign = if size > 0 && text.[0] = '-' then 1 else 0 in
    let digits = String.sub text sign (size - sign) in
    if digits = "" || size > 20000 || not (String.for_all (fun c -> c >= '0' && c <= '9') digits)
       || (digits.[0] = '0' && text <> "0") then malformed "not an integer of at most 20000 digits";
    Z.of_string text
  | _ -> malformed "not an integer as a string"

let direction value = match map integer (list value) with
  | [ x; y; z0 ] -> { x; y; z0 }
  | _ -> malformed "a direction has three components"

let relation = function
  | Json.Null -> None
  | Json.String "apart" -> Some Apart
  | Json.String "touching" -> Some Touching
  | Json.String "crossing" -> Some Crossing
  | _ -> malformed "an unknown relation"

let most_faces = 1 lsl 24

let order value =
  let add (taken, n) entry =
    let first, last = match entry with
      | Json.List [ first; last ] -> (Z.to_int (whole first), Z.to_int (whole last))
      | Json.List _ -> malformed "a run is the first and the last number"
      | number -> let n = Z.to_int (whole number) in (n, n) in
    if first > last || last - first + n >= most_faces then malformed "an order of more than 2^24 faces, or a run back";
    let rec run i taken = if i > last then taken else run (i + 1) (Z.of_int i :: taken) in
    (run first taken, n + last - first + 1) in
  List.rev (fst (List.fold_left add ([], 0) (list value)))

let hash = function
  | Json.String text when String.length text = 16
                       && String.for_all (function '0' .. '9' | 'a' .. 'f' -> true | _ -> false) text -> text
  | _ -> malformed "not a hash of 16 digits"

let edge = function
  | Json.String text when String.length text = 2 && (text.[0] = 'a' || text.[0] = 'b') && text.[1] >= '1' && text.[1] <= '3' ->
    { edge_of = (if text.[0] = 'a' then SideA else SideB); edge_to = Char.code text.[1] - 48 }
  | _ -> malformed "an edge is a1 to a3 or b1 to b3"

let version_key = "collisionchip_certificate"
let fields = function Json.Object fields -> fields | _ -> malformed "not an object"

let cell ~halving line =
  let f = fields line in
  let split side = Split (side, if halving then None else Some (whole (get f "at"))) in
  let point why = match list (get f "faces") with
    | [ a; b ] -> Shared (whole a, whole b, map integer (list (get f "a")), map integer (list (get f "b")), why)
    | _ -> malformed "a point needs two faces" in
  match get f "cell" with
  | Json.String "split_a" -> split SideA
  | Json.String "split_b" -> split SideB
  | Json.String "separated" -> Separated (direction (get f "direction"))
  | Json.String "meet" -> point Meet
  | Json.String "near" -> point Near
  | Json.String "touch" -> point (Touch (direction (get f "direction")))
  | Json.String "cross" ->
    (match map edge (list (get f "span")) with
     | [ a; b; c ] -> point (Cross (a, b, c))
     | _ -> malformed "a span is three edges")
  | _ -> malformed "an unknown kind of cell"

(* A number as the nearest double. *)
let double = function
  | Json.Whole n -> float_of_string (Z.to_string n)
  | Json.Other_number value -> value
  | _ -> malformed "not a number"

let distance value =
  let value = double value in
  if value > 0.0 then exact value else malformed "a distance is above 0"

(* What counts as a contact, and why the claim is refused, if it is. *)
let criterion f =
  let least = relation (get f "least") in
  let along = Option.map (fun value -> List.map double (list value)) (Json.find "along" f) in
  match Json.find "within" f, Json.find "below" f, along, least with
  | Some _, Some _, _, _ -> malformed "two distances"
  | _, _, _, None -> malformed "an unknown kind of contacts"
  | within, below, along, Some least ->
    let counted = match Option.map distance within, Option.map distance below, along with
      | Some w, _, None -> Within w
      | None, Some w, None -> Below w
      | None, None, Some [ x; y; z0 ] -> Along { x = exact x; y = exact y; z0 = exact z0 }
      | None, None, None -> if least = Crossing then CrossingOnly else Meeting
      | _, _, Some [ _; _; _ ] -> Meeting (* refused below *)
      | _ -> malformed "a translation has three numbers" in
    let other = within <> None || below <> None || along <> None in
    let fault =
      if least = Apart || (other && least <> Touching) then Some "an unknown kind of contacts"
      else if along <> None && (within <> None || below <> None) then Some "a distance and a translation"
      else if along = Some [ 0.0; 0.0; 0.0 ] then Some "the translation is 0"
      else None in
    (counted, fault)

(* The number of the version, if it is one. *)
let version fields = match Json.find version_key fields with
  | Some (Json.Whole n) when Z.leq Z.one n && Z.leq n (Z.of_int 3) -> Z.to_int n
  | _ -> malformed "no certificate of version 1, 2 or 3"

let claim f cells =
  let counted, fault = criterion f in
  let version = version f in
  let all = match get f "all" with Json.Bool all -> all | _ -> malformed "all is true or false" in
  let expected = if List.exists (fun key -> Json.find key f <> None) [ "within"; "below"; "along" ] then 2 else 1 in
  let fault =
    if version = 3 then if all then fault else Some "a certificate of version 3 is of all contacts"
    else if version = expected then fault else Some "a version that does not fit the claim" in
  let contact value = match list value with
    | [ a; b; told ] -> { face_a = whole a; face_b = whole b; told = relation told }
    | _ -> malformed "a contact is two faces and a relation" in
  let contacts = map contact (list (get f "contacts")) in
  let halving = version = 3 in
  let order key = if halving then [] else order (get f key) in
  { certificate =
      { claimed = { all; counted; relation_of_meshes = relation (get f "relation"); contacts };
        halving; order_a = order "order_a"; order_b = order "order_b"; cells };
    mesh_hashes = (hash (get f "mesh_a"), hash (get f "mesh_b")); poses_hash = hash (get f "poses");
    trees = if halving then Some (hash (get f "tree_a"), hash (get f "tree_b")) else None;
    fault }

let begins = function Json.Object fields -> Json.find version_key fields <> None | _ -> false

(* The lines of a file; only a line feed ends a line. *)
let lines_of text =
  let lines = String.split_on_char '\n' text in
  match List.rev lines with "" :: rest -> List.rev rest | _ -> lines

(* Takes the next certificate off the lines; nothing if there are none. *)
let next_certificate lines = match lines with
  | [] -> None
  | first :: rest ->
    let first = fields (Json.parse first) in
    let halving = version first = 3 in
    let rec cells taken = function
      | [] -> (List.rev taken, [])
      | line :: rest as lines ->
        let value = Json.parse line in
        if begins value then (List.rev taken, lines) else cells (cell ~halving value :: taken) rest in
    let cells, rest = cells [] rest in
    Some (claim first cells, rest)

(* Trees. *)

type tree_read = { faces_in_order : Z.t list; of_mesh : string; tree_hash : string }

let read_tree path =
  try
    match lines_of (read_file path) with
    | [ line ] ->
      let f = fields (Json.parse line) in
      if Json.find "collisionchip_tree" f <> Some (Json.Whole Z.one) then malformed "no tree of version 1";
      let of_mesh = hash (get f "mesh") and faces_in_order = order (get f "order") in
      let words = Int64.of_string ("0x" ^ of_mesh) :: map Z.to_int64 faces_in_order in
      { faces_in_order; of_mesh; tree_hash = hash_words words }
    | _ -> malformed "a tree is one line"
  with Json.Malformed what -> unreadable "%s: %s" path what
