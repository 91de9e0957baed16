;;; emacs.el --- What a user does in Emacs  -*- lexical-binding: t; -*-

;; emacs -Q --batch -L editors/emacs -l editors/test/emacs.el FOLDER/four_bar.mech

;;; Code:

(require 'cl-lib)
(require 'package)
;; that of the distribution, where Emacs has none of its own
(add-to-list 'package-directory-list "/usr/share/emacs/site-lisp/elpa")
(package-initialize)
(require 'eglot)
(require 'mech-mode)

(defconst patience 20)
(defvar begun (float-time))
(setq eglot-sync-connect t
      eglot-confirm-server-initiated-edits nil
      create-lockfiles nil
      make-backup-files nil)

(defun wait (what condition)
  "Wait for WHAT, until CONDITION holds."
  (let ((until (+ (float-time) patience)))
    (while (not (funcall condition))
      (when (> (float-time) until)
        (error "Waited in vain for %s" what))
      ;; nobody is idle here, which is when an editor tells of changes
      (when (eglot-current-server)
        (eglot--signal-textDocument/didChange))
      (accept-process-output nil 0.02))))

(defun messages ()
  "What the editor shows."
  (mapcar #'flymake-diagnostic-text (flymake-diagnostics)))

(defun says (words)
  "Whether a diagnostic has WORDS."
  (cl-some (lambda (message) (string-search words message)) (messages)))

(defun behind (words)
  "Go behind WORDS."
  (goto-char (point-min))
  (search-forward words))

(defun step-diagnostic ()
  (wait "the diagnostics" (lambda () (says "no kind of joint `revolut`")))
  (unless (says "expected a name") (error "%S" (messages))))

(defun step-fix ()
  (behind "revolut(")
  (let* ((place (- (point) 2))
         (actions (eglot-code-actions place place))
         (titles (mapcar (lambda (action) (plist-get action :title)) actions))
         (wanted (cl-find-if (lambda (action) (string-search "revolute" (plist-get action :title))) actions)))
    (unless wanted (error "No fix among %S" titles))
    (let ((whole (if (plist-get wanted :edit) wanted
                   (jsonrpc-request (eglot--current-server-or-lose) :codeAction/resolve wanted))))
      (eglot--apply-workspace-edit (plist-get whole :edit)))
    (wait "the mistake to go" (lambda () (not (says "no kind of joint"))))))

(defun step-complete ()
  (behind "y(coupler.")
  (let* ((completion (eglot-completion-at-point))
         (table (nth 2 completion))
         (candidates (all-completions "" table (plist-get (nthcdr 3 completion) :predicate)))
         (wanted (cl-find "C" candidates :test #'string=)))
    (unless (and wanted (cl-find "B" candidates :test #'string=) (not (cl-find "pin" candidates :test #'string=)))
      (error "%S" candidates))
    (insert wanted)
    (funcall (plist-get (nthcdr 3 completion) :exit-function) wanted 'finished))
  (wait "no diagnostics" (lambda () (null (messages)))))

(defun step-rename ()
  (behind "drive.crank")
  (backward-char)
  ;; asks whether a file that is not open may be changed
  (cl-letf (((symbol-function 'y-or-n-p) #'always))
    (eglot-rename "lever")))

(defun step-format ()
  (eglot-format-buffer))

(defun step-hover ()
  (behind "y(coupler.")
  (let ((hover (jsonrpc-request (eglot--current-server-or-lose) :textDocument/hover (eglot--TextDocumentPositionParams))))
    (unless (string-search "C" (format "%S" hover)) (error "Nothing is told of the point"))))

(defun step-save ()
  (save-some-buffers t))

(defun colour (words)
  "The face of the last of WORDS' letters."
  (save-excursion (behind words) (get-text-property (1- (point)) 'face)))

(defun step-colours ()
  "Colours do not depend on the server."
  (with-temp-buffer
    (insert "/// A body.\nmechanism a { param at = 3 mm + sin(t) // here\n"
            "body to at (0, 0, 5 deg) { point in = (0, 0) }\n"
            "joint j: rack_pinion(to.in, ground.g, 0, left)\nmeasure every = x(to.in) in mm }\n")
    (mech-mode)
    (font-lock-ensure)
    (pcase-dolist (`(,words ,face)
                   '(("A body" font-lock-comment-face) ("mechanism" font-lock-keyword-face) ("param at" font-lock-variable-name-face)
                     ("3 mm" font-lock-type-face) ("sin" font-lock-builtin-face) ("(t" font-lock-constant-face)
                     ("here" font-lock-comment-face) ("body to" font-lock-variable-name-face) ("to at" font-lock-keyword-face)
                     ("rack_pinion" font-lock-type-face) ("left" font-lock-constant-face) ("x(to" nil) ("to.in" nil)
                     ("point in" font-lock-variable-name-face) (") in" font-lock-keyword-face)))
      (unless (eq (colour words) face)
        (error "`%s' is %s, not %s" words (colour words) face)))
    (goto-char (point-min))
    (let ((words (with-temp-buffer (insert-file-contents (getenv "WORDS")) (json-parse-buffer :array-type 'list :object-type 'alist))))
      (erase-buffer)
      (dolist (word words)
        (let ((name (alist-get 'name word)))
          (erase-buffer)
          (insert (if (member name '("use" "as" "columns"))
                      "use \"a.mech\" as b\nmechanism c { table d = spline \"e.csv\" columns 1, 2 (s, mm) }"
                    (alist-get 'example word)))
          (font-lock-ensure)
          (unless (save-excursion
                    (goto-char (point-min))
                    (cl-loop while (re-search-forward (concat "\\_<" (regexp-quote name) "\\_>") nil t)
                             thereis (memq (get-text-property (match-beginning 0) 'face)
                                           '(font-lock-keyword-face font-lock-builtin-face font-lock-type-face font-lock-constant-face))))
            (error "`%s' has no colour in %s" name (buffer-string))))))
    (erase-buffer)
    (insert "mechanism a {\nbody b {\npoint P = (1,\n2)\n}\n}\n")
    (indent-region (point-min) (point-max))
    (unless (string= (buffer-string) "mechanism a {\n    body b {\n        point P = (1,\n            2)\n    }\n}\n")
      (error "Indented as %s" (buffer-string)))))

(condition-case fault
    (progn
      (find-file (car command-line-args-left))
      (setq command-line-args-left nil)
      (let ((steps (split-string (or (getenv "STEPS") "colours diagnostic fix complete rename format hover save"))))
        (unless (equal steps '("colours"))
          (apply #'eglot (eglot--guess-contact)))
        (dolist (step steps)
          (condition-case fault
              (funcall (intern (concat "step-" step)))
            (error (error "%s: %s" step (error-message-string fault))))
          (princ (format "%s after %d ms\n" step (* 1000 (- (float-time) begun))))))
      (princ "emacs: all steps\n"))
  (error (princ (format "emacs: %s\n" (error-message-string fault)))
         (kill-emacs 1)))

;;; emacs.el ends here
