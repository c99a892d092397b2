(* SPDX-License-Identifier: Apache-2.0 *)
(* The program cchip-checked: the command line of `cchip check` around the proved checker. *)
open Reader

let usage = "usage: cchip-checked A B FILE [--pose tx,ty,tz | --pose-matrix N,N,... | --poses CSV] [--single]\n\
             \                           [--tree-a TREE --tree-b TREE]\n\
             \       cchip-checked --batch LIST\n\
             Lines of LIST: A, B, FILE, the twelve numbers of --pose-matrix and, if there are any, two trees, with tabs between them; prints a verdict for each.\n\
             Exit codes: 0 all accepted, 1 a certificate is refused, 2 a file or the command line cannot be read"

let reason total (verdict : Checked.verdict) = match verdict with
  | Accepted -> None
  | ScaleFault -> Some "claim: the numbers have no common scale"
  | ShapeFault -> Some "claim: a face is neither triangle nor quad"
  | OrderFault -> Some "cell 0: an order does not hold each face once, or one contact is not one cell"
  | ClaimFault -> Some "claim: it does not follow from the cells"
  | CellsFault rest -> Some (Printf.sprintf "cell %d: it does not hold, or cells are missing" (total - List.length rest))

(* Two meshes, and what is made once for all their certificates; with trees, if these are given. *)
type pair =
  { a : mesh_read; b : mesh_read; prepared : Checked.prepared Lazy.t;
    given : (tree_read * tree_read * (Checked.group * Checked.group) option Lazy.t) option }

let pair a b trees =
  let prepared = lazy (Checked.prepare a.faces b.faces) in
  let read (of_a, of_b) =
    let of_a = read_tree of_a and of_b = read_tree of_b in
    (of_a, of_b, lazy (Checked.trees_of (Lazy.force prepared) of_a.faces_in_order of_b.faces_in_order)) in
  { a; b; prepared; given = Option.map read trees }

(* The trees that the certificate cites, if it cites any, or why it is refused. *)
let cited pair read = match read.trees, pair.given with
  | None, _ -> Ok None
  | Some _, None -> unreadable "the certificate cites trees: give them with --tree-a and --tree-b"
  | Some hashes, Some (of_a, of_b, trees) ->
    if (of_a.of_mesh, of_b.of_mesh) <> (pair.a.hash, pair.b.hash) then Error "cell 0: a tree is of another mesh"
    else if hashes <> (of_a.tree_hash, of_b.tree_hash) then Error "cell 0: the certificate cites other trees"
    else Ok (Lazy.force trees)

(* Nothing, or why the certificate is refused. *)
let check pair pose read =
  if read.fault <> None then Option.map (fun why -> "claim: " ^ why) read.fault
  else if read.mesh_hashes <> (pair.a.hash, pair.b.hash) then Some "cell 0: the certificate is of other meshes"
  else if read.poses_hash <> hash_poses identity pose then Some "cell 0: the certificate is of other poses"
  else match cited pair read with
    | Error why -> Some why
    | Ok trees ->
      reason (List.length read.certificate.cells)
        (Checked.check_prepared (Lazy.force pair.prepared) trees (to_pose identity) (to_pose pose) read.certificate)

let in_words read =
  let c = read.certificate.claimed in
  let relation : Checked.relation option -> string = function
    | None -> "" | Some Apart -> ", apart" | Some Touching -> ", touching" | Some Crossing -> ", crossing" in
  let faces_are, what = match c.counted with
    | Meeting -> ("meets", "")
    | CrossingOnly -> ("crosses", " of faces that cross")
    | Within w -> ("is within " ^ to_text w ^ " of", " within " ^ to_text w)
    | Below w -> ("is nearer than " ^ to_text w ^ " to", " below " ^ to_text w)
    | Along t ->
      ("meets", Printf.sprintf " after any move of B along (%s, %s, %s)" (to_text t.x) (to_text t.y) (to_text t.z0)) in
  let contacts = match c.all, c.contacts with
    | false, k :: _ ->
      Printf.sprintf "face %s of A %s face %s of B" (Z.to_string k.face_a) faces_are (Z.to_string k.face_b)
    | _, [] -> "no contacts" ^ what
    | _, l -> let n = List.length l in Printf.sprintf "%d contact%s%s and no others" n (if n = 1 then "" else "s") what in
  contacts ^ relation c.relation_of_meshes

let run a b trees file poses ~numbered ~single =
  let checked = ref 0 and refused = ref 0 in
  let poses = poses () in
  let a = read_mesh ~single a in
  let pair = pair a (read_mesh ~single b) trees in
  let wrong_number which =
    unreadable "%s: it holds %s certificates than there are poses, %d" file which !checked in
  let next lines =
    try next_certificate lines with Json.Malformed what -> unreadable "%s: certificate %d: %s" file (!checked + 1) what in
  let one lines pose = match next lines with
    | None -> wrong_number "fewer"
    | Some (read, rest) ->
      incr checked;
      if numbered then Printf.printf "certificate %d " !checked;
      (match check pair pose read with
       | None -> Printf.printf "accepted: %s\n" (in_words read)
       | Some why -> incr refused; Printf.printf "refused: %s\n" why);
      rest in
  let rest = List.fold_left one (lines_of (read_file file)) poses in
  if next rest <> None then wrong_number "more";
  Printf.printf "certificates=%d accepted=%d refused=%d\n" !checked (!checked - !refused) !refused;
  if !refused > 0 then 1 else 0

let batch list =
  let last = ref ("", None) and other = ref ("", None) in
  let mesh cache path = match !cache with
    | p, Some mesh when p = path -> mesh
    | _ -> let mesh = read_mesh path in cache := (path, Some mesh); mesh in
  let line text = match String.split_on_char '\t' text with
    | a :: b :: file :: pose :: ([] | [ _; _ ] as trees) ->
      (try
         let a = mesh last a in
         let pair = pair a (mesh other b) (match trees with [ of_a; of_b ] -> Some (of_a, of_b) | _ -> None) in
         let pose = pose_of_matrix pose in
         let rec all n lines = match next_certificate lines with
           | None -> if n = 0 then "malformed: no certificate" else "accepted"
           | Some (read, rest) ->
             (match check pair pose read with None -> all (n + 1) rest | Some why -> "refused: " ^ why) in
         all 0 (lines_of (read_file file))
       with Unreadable what | Json.Malformed what -> "malformed: " ^ what)
    | _ -> unreadable "%s: a line is not A, B, FILE, a pose and at most two trees with tabs between them" list in
  List.iter (fun text -> print_endline (line text)) (lines_of (read_file list));
  0

let rec options values = function
  | [] -> values
  | "--single" :: rest -> options (("--single", "") :: values) rest
  | word :: rest when String.length word > 2 && String.sub word 0 2 = "--" ->
    (match String.index_opt word '=', rest with
     | Some i, _ -> options ((String.sub word 0 i, String.sub word (i + 1) (String.length word - i - 1)) :: values) rest
     | None, value :: rest -> options ((word, value) :: values) rest
     | None, [] -> unreadable "%s: its value is missing\n%s" word usage)
  | word :: rest -> options (("", word) :: values) rest

let main arguments =
  let values = List.rev (options [] arguments) in
  let named name = List.filter_map (fun (n, v) -> if n = name then Some v else None) values in
  List.iter (fun (n, _) -> if not (List.mem n [ ""; "--single"; "--pose"; "--pose-matrix"; "--poses"; "--batch"; "--tree-a"; "--tree-b" ])
              then unreadable "%s: no such option\n%s" n usage) values;
  let single = named "--single" <> [] in
  let trees = match named "--tree-a", named "--tree-b" with
    | [], [] -> None
    | [ a ], [ b ] -> Some (a, b)
    | _ -> unreadable "write --tree-a and --tree-b, each once\n%s" usage in
  match named "", named "--batch", named "--pose", named "--pose-matrix", named "--poses" with
  | [], [ list ], [], [], [] when not single && trees = None -> batch list
  | [ a; b; file ], [], [], [], [] -> run a b trees file (fun () -> [ identity ]) ~numbered:false ~single
  | [ a; b; file ], [], [ p ], [], [] -> run a b trees file (fun () -> [ pose_of_option p ]) ~numbered:false ~single
  | [ a; b; file ], [], [], [ p ], [] -> run a b trees file (fun () -> [ pose_of_matrix p ]) ~numbered:false ~single
  | [ a; b; file ], [], [], [], [ p ] -> run a b trees file (fun () -> poses_of_csv p) ~numbered:true ~single
  | _ -> unreadable "%s" usage

let () =
  (* Meshes live until the end, so a large heap for young values saves a third of the time. *)
  Gc.set { (Gc.get ()) with minor_heap_size = 1 lsl 22; space_overhead = 200 };
  exit
    (try main (List.tl (Array.to_list Sys.argv)) with
     | Unreadable what -> flush stdout; prerr_endline ("cchip-checked: " ^ what); 2
     | Stack_overflow -> flush stdout; prerr_endline "cchip-checked: the stack is too small for these files; run ulimit -s unlimited first"; 1)
